#include "dynamics/linear/steady_motion.h"

#include <array>
#include <cmath>
#include <vector>

#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/dense/vector_span.h"

namespace sprung::dynamics {

namespace {

constexpr double kAllowed = 1e-9;  // residual of the constraints, of the prescribed rates
constexpr double kSame = 1e-6;     // difference of accelerations that counts as none, of the largest one
constexpr double kOffset = 1e-3;   // distance from the equilibrium of the comparison [natural sizes]
constexpr std::array<double, 2> kTurns{0.7, 2.1};  // later positions of the motion [rad, or length scales]

// ρ̈ of a system at rest relative to the motion, at positions q and a time, rotated back to time 0; empty
// where q does not satisfy the constraints.
Eigen::VectorXd calc_carried_acceleration(const Model& model, const SteadyMotion& motion,
                                          const Eigen::VectorXd& q, double time) {
  PartitionedEquations equations(model);
  equations.choose_partition_at(time, q);
  const Eigen::VectorXd q_i = q(equations.partition().independent);
  const Eigen::VectorXd v_i = motion.calc_velocity(model, q)(equations.partition().independent);
  if (equations.update_positions(time, support::as_span(q_i)) != PartitionedEquations::Outcome::kGood)
    return {};
  for (int i = 0; i < model.num_coordinates; ++i) {
    if (std::abs(equations.q()[i] - q[i]) > kAllowed * model.coordinate_scale(i)) return {};
  }
  equations.update_velocities(support::as_span(v_i));
  equations.update_accelerations(equations.terms().find_branches());
  const Eigen::VectorXd relative =
      equations.v_dot() - motion.calc_acceleration(model, equations.q(), equations.v());
  return motion.rotate_back(model, relative, time);
}

}  // namespace

Eigen::VectorXd SteadyMotion::calc_velocity(const Model& model, const Eigen::VectorXd& q) const {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(model.num_coordinates);
  for (const Body& body : model.bodies) {
    const Eigen::Vector2d R = q.segment<2>(body.first_coordinate);
    w.segment<2>(body.first_coordinate) = velocity + omega * turned(R);
    w[body.first_coordinate + 2] = omega;
  }
  return w;
}

Eigen::VectorXd SteadyMotion::calc_acceleration(const Model& model, const Eigen::VectorXd& q,
                                                const Eigen::VectorXd& v) const {
  const Eigen::VectorXd sum = 2.0 * v - calc_velocity(model, q);  // 2ρ̇ + w
  Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(model.num_coordinates);
  for (const Body& body : model.bodies) {
    acceleration.segment<2>(body.first_coordinate) = omega * turned(sum.segment<2>(body.first_coordinate));
  }
  return acceleration;
}

Eigen::VectorXd SteadyMotion::move_positions(const Model& model, Eigen::VectorXd q, double time) const {
  const FrameRotation rotation = FrameRotation::from_angle(omega * time);
  for (const Body& body : model.bodies) {
    auto R = q.segment<2>(body.first_coordinate);
    if (omega == 0.0) {
      R += time * velocity;
    } else {
      const Eigen::Vector2d center = turned(velocity) / omega;  // where w is zero
      R = center + rotation * Eigen::Vector2d(R - center);
    }
    q[body.first_coordinate + 2] += omega * time;
  }
  return q;
}

Eigen::VectorXd SteadyMotion::rotate_back(const Model& model, Eigen::VectorXd vectors, double time) const {
  const FrameRotation rotation = FrameRotation::from_angle(-omega * time);
  for (const Body& body : model.bodies) {
    auto part = vectors.segment<2>(body.first_coordinate);
    part = (rotation * Eigen::Vector2d(part)).eval();
  }
  return vectors;
}

std::optional<SteadyMotion> find_steady_motion(const Model& model, const Eigen::VectorXd& q) {
  if (!model.has_moving_joints) return SteadyMotion{};
  SystemTerms terms(model);
  terms.update_positions(0.0, q);
  terms.update_jacobian();
  Eigen::VectorXd phi_t(model.num_constraints);
  terms.calc_time_rate(phi_t);
  Eigen::MatrixXd rigid(model.num_coordinates, 3);
  rigid.col(0) = SteadyMotion{.velocity = {1.0, 0.0}}.calc_velocity(model, q);
  rigid.col(1) = SteadyMotion{.velocity = {0.0, 1.0}}.calc_velocity(model, q);
  rigid.col(2) = SteadyMotion{.omega = 1.0}.calc_velocity(model, q);
  const Eigen::MatrixXd allowed = terms.jacobian().dense() * rigid;
  // What a translation can do is not left to a rotation, which the forces of a road do not follow.
  for (const Eigen::Index num_motions : {2, 3}) {
    const Eigen::MatrixXd tried = allowed.leftCols(num_motions);
    Eigen::Vector3d found = Eigen::Vector3d::Zero();
    found.head(num_motions) = support::solve_least_squares(tried, -phi_t);
    if ((tried * found.head(num_motions) + phi_t).norm() <= kAllowed * phi_t.norm())
      return SteadyMotion{.velocity = found.head<2>(), .omega = found[2]};
  }
  return std::nullopt;
}

bool is_steady(const Model& model, const SteadyMotion& motion, const Eigen::VectorXd& q) {
  if (motion.is_rest()) return true;
  // Slightly away from the equilibrium, so that the forces of stiff elements are compared as well.
  PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  Eigen::VectorXd q_i(equations.num_freedoms());
  for (Eigen::Index k = 0; k < q_i.size(); ++k) {
    const int i = equations.partition().independent[static_cast<std::size_t>(k)];
    q_i[k] = q[i] + kOffset * std::cos(1.7 * static_cast<double>(k + 1)) * model.coordinate_scale(i);
  }
  if (equations.update_positions(0.0, support::as_span(q_i)) != PartitionedEquations::Outcome::kGood)
    return false;
  const Eigen::VectorXd place = equations.q();
  const Eigen::VectorXd here = calc_carried_acceleration(model, motion, place, 0.0);
  const Eigen::VectorXd w = motion.calc_velocity(model, place);
  const double size =
      model.largest_natural(here) + model.largest_natural(motion.calc_acceleration(model, place, w));
  for (const double turn : kTurns) {
    const double time =
        turn / (motion.omega != 0.0 ? std::abs(motion.omega) : motion.velocity.norm() / model.length_scale);
    const Eigen::VectorXd there =
        calc_carried_acceleration(model, motion, motion.move_positions(model, place, time), time);
    if (there.size() != here.size() || model.largest_natural(there - here) > kSame * size) return false;
  }
  return true;
}

}  // namespace sprung::dynamics

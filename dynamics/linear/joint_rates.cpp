#include "dynamics/linear/joint_rates.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "dynamics/linear/linear_vehicle.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kSameRate = 1e-6;        // share of a rate that counts as no contradiction
constexpr double kNoRate = 1e-12;         // m/s or rad/s that counts as none
constexpr double kDetermined = 1e-11;     // mobility left by the joints, of that without joints
constexpr double kSingularPivot = 1e-12;  // of the largest

// The velocities that joints allow, and the least changes among them (linear, eq. 17).
class AllowedVelocities {
 public:
  // @param inverse_mass  nq; coordinates with 0 do not change
  AllowedVelocities(const SystemTerms& terms, const Eigen::VectorXd& inverse_mass)
      : inverse_mass_(inverse_mass), Phi_q_(terms.jacobian().sparse()) {
    if (Phi_q_.rows() == 0) return;
    factor_.compute(Phi_q_ * inverse_mass_.asDiagonal() * Phi_q_.transpose());
    if (factor_.info() != Eigen::Success) {
      is_singular_ = true;
      return;
    }
    const Eigen::VectorXd D = factor_.vectorD();
    is_singular_ = !(D.minCoeff() > kSingularPivot * D.maxCoeff());
  }
  bool is_singular() const { return is_singular_; }

  // P M⁻¹ g
  Eigen::VectorXd calc_response(const Eigen::VectorXd& g) const {
    Eigen::VectorXd response = inverse_mass_.cwiseProduct(g);
    if (Phi_q_.rows() == 0) return response;
    for (int pass = 0; pass < 2; ++pass) {  // the second removes the rounding of the first
      const Eigen::VectorXd lambda = factor_.solve(Phi_q_ * response);
      response -= inverse_mass_.cwiseProduct(Phi_q_.transpose() * lambda);
    }
    return response;
  }

 private:
  Eigen::VectorXd inverse_mass_;
  Eigen::SparseMatrix<double> Phi_q_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool is_singular_ = false;
};

// Derivative of a joint's coordinate by all coordinates, nq.
Eigen::VectorXd calc_coordinate_gradient(const SystemTerms& terms, const Joint& joint) {
  const std::span<const MarkerState> markers = terms.markers();
  const RelativeCoordinate::Gradient G = joint.coordinate()->gradient(
      markers[static_cast<std::size_t>(joint.marker_a)], markers[static_cast<std::size_t>(joint.marker_b)]);
  return (G.a * calc_marker_jacobian(terms, joint.marker_a) +
          G.b * calc_marker_jacobian(terms, joint.marker_b))
      .transpose();
}

Eigen::VectorXd find_mobile_masses(const SystemTerms& terms, bool modes_move) {
  Eigen::VectorXd inverse = terms.calc_metric().cwiseInverse();
  for (const Body& body : terms.model().bodies) {
    if (!modes_move) inverse.segment(body.first_coordinate + 3, body.num_modes()).setZero();
  }
  return inverse;
}

std::unique_ptr<const AllowedVelocities> make_allowed_velocities(const SystemTerms& terms) {
  for (const bool modes_move : {false, true}) {
    auto allowed = std::make_unique<const AllowedVelocities>(terms, find_mobile_masses(terms, modes_move));
    if (!allowed->is_singular()) return allowed;
  }
  throw support::NumericalError(
      "the joints allow no velocities at t = 0 s: a singular position; start slightly away from it");
}

void check_same(const Joint& joint, const JointRate& wanted, double required) {
  const double size = std::max(std::abs(wanted.rate), std::abs(required));
  if (std::abs(wanted.rate - required) <= kSameRate * size + kNoRate) return;
  const char* unit = joint.coordinate()->is_angle() ? "rad/s" : "m/s";
  throw support::InputError(
      wanted.location,
      fmt::format("'joint_rates.{}' must be {:.6g} {}, as the joints, prescribed motion and the rates before "
                  "it require, got {:.6g}",
                  joint.name, std::abs(required) <= kNoRate ? 0.0 : required, unit, wanted.rate));
}

}  // namespace

void impose_joint_rates(const Model& model, const Eigen::VectorXd& q, std::span<const JointRate> rates,
                        Eigen::VectorXd& v) {
  if (rates.empty()) return;
  SystemTerms terms(model);
  terms.update_positions(0.0, q);
  terms.update_jacobian();
  terms.update_mass();
  const std::unique_ptr<const AllowedVelocities> allowed = make_allowed_velocities(terms);
  const Eigen::VectorXd inverse_mass = terms.calc_metric().cwiseInverse();
  // Changes of velocity that leave the rates before them as they are, each with that of its own rate.
  std::vector<Eigen::VectorXd> gradients, changes;
  for (const JointRate& wanted : rates) {
    const Joint& joint = *model.joints[static_cast<std::size_t>(wanted.joint)];
    const Eigen::VectorXd g = calc_coordinate_gradient(terms, joint);
    const double without_joints = g.dot(inverse_mass.cwiseProduct(g));
    Eigen::VectorXd change = allowed->calc_response(g);
    for (std::size_t k = 0; k < changes.size(); ++k) {
      change -= gradients[k].dot(change) / gradients[k].dot(changes[k]) * changes[k];
    }
    const double mobility = g.dot(change);
    if (mobility <= kDetermined * without_joints) {
      check_same(joint, wanted, g.dot(v));
      continue;
    }
    v += (wanted.rate - g.dot(v)) / mobility * change;
    gradients.push_back(g);
    changes.push_back(change);
  }
}

}  // namespace sprung::dynamics

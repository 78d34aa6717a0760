#include "dynamics/linear/joint_rates.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kSameRate = 1e-6;        // share of a rate that counts as no contradiction
constexpr double kNoRate = 1e-12;         // m/s or rad/s that counts as none
constexpr double kDetermined = 1e-9;      // mobility left by the joints, of that without joints
constexpr double kSingularPivot = 1e-12;  // of the largest

// The velocities that joints allow, and the least changes among them (linear, eq. 10).
class AllowedVelocities {
 public:
  // @param inverse_metric  nq; coordinates with 0 do not change
  AllowedVelocities(const SystemTerms& terms, Eigen::VectorXd inverse_metric)
      : inverse_metric_(std::move(inverse_metric)), Phi_q_(terms.jacobian().sparse()) {
    if (Phi_q_.rows() == 0) return;
    Eigen::SparseMatrix<double> S = Phi_q_ * inverse_metric_.asDiagonal() * Phi_q_.transpose();
    // Rows of positions and of angles have other units.
    scales_ = S.diagonal().cwiseSqrt().cwiseInverse();
    S = scales_.asDiagonal() * S * scales_.asDiagonal();
    factor_.compute(S);
    if (factor_.info() != Eigen::Success) {
      is_singular_ = true;
      return;
    }
    const Eigen::VectorXd D = factor_.vectorD();
    is_singular_ = !(D.minCoeff() > kSingularPivot * D.maxCoeff());
  }
  bool is_singular() const { return is_singular_; }

  // The change of velocities with the largest gᵀv that leaves the rates before it as they are.
  Eigen::VectorXd calc_change(const Eigen::VectorXd& g) const {
    Eigen::VectorXd change = calc_response(g);
    for (std::size_t k = 0; k < changes_.size(); ++k)
      change -= gradients_[k].dot(change) / gradients_[k].dot(changes_[k]) * changes_[k];
    return change;
  }
  void keep_rate(const Eigen::VectorXd& g, const Eigen::VectorXd& change) {
    gradients_.push_back(g);
    changes_.push_back(change);
  }
  // gᵀw of a change, of that without joints and other rates.
  double calc_mobility(const Eigen::VectorXd& g, const Eigen::VectorXd& change) const {
    return g.dot(change) / g.dot(inverse_metric_.cwiseProduct(g));
  }

 private:
  // P D² g
  Eigen::VectorXd calc_response(const Eigen::VectorXd& g) const {
    Eigen::VectorXd response = inverse_metric_.cwiseProduct(g);
    if (Phi_q_.rows() == 0) return response;
    for (int pass = 0; pass < 2; ++pass) {  // the second removes the rounding of the first
      const Eigen::VectorXd lambda =
          scales_.cwiseProduct(factor_.solve(scales_.cwiseProduct(Phi_q_ * response)));
      response -= inverse_metric_.cwiseProduct(Phi_q_.transpose() * lambda);
    }
    return response;
  }

  Eigen::VectorXd inverse_metric_;
  Eigen::SparseMatrix<double> Phi_q_;
  Eigen::VectorXd scales_;  // of the rows
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool is_singular_ = false;
  std::vector<Eigen::VectorXd> gradients_, changes_;  // of the rates that are kept
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

// With 0 for modes, if they do not move.
Eigen::VectorXd select_mobile(const Model& model, Eigen::VectorXd inverse_metric, bool modes_move) {
  for (const Body& body : model.bodies) {
    if (!modes_move) inverse_metric.segment(body.first_coordinate + 3, body.num_modes()).setZero();
  }
  return inverse_metric;
}

// The squares of the natural sizes, nq.
Eigen::VectorXd calc_natural_metric(const Model& model) {
  Eigen::VectorXd inverse_metric(model.num_coordinates);
  for (int i = 0; i < model.num_coordinates; ++i)
    inverse_metric[i] = model.coordinate_scale(i) * model.coordinate_scale(i);
  return inverse_metric;
}

std::unique_ptr<AllowedVelocities> make_allowed_velocities(const SystemTerms& terms,
                                                           const Eigen::VectorXd& inverse_metric) {
  for (const bool modes_move : {false, true}) {
    auto allowed =
        std::make_unique<AllowedVelocities>(terms, select_mobile(terms.model(), inverse_metric, modes_move));
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
  // Whether a rate is determined is a matter of the positions, and not of the masses.
  const auto by_mass = make_allowed_velocities(terms, terms.calc_metric().cwiseInverse()),
             by_position = make_allowed_velocities(terms, calc_natural_metric(model));
  for (const JointRate& wanted : rates) {
    const Joint& joint = *model.joints[static_cast<std::size_t>(wanted.joint)];
    const Eigen::VectorXd g = calc_coordinate_gradient(terms, joint);
    const Eigen::VectorXd possible = by_position->calc_change(g);
    // No number where the rate is one of modes alone, which do not move.
    if (!(by_position->calc_mobility(g, possible) > kDetermined)) {
      check_same(joint, wanted, g.dot(v));
      continue;
    }
    const Eigen::VectorXd change = by_mass->calc_change(g);
    v += (wanted.rate - g.dot(v)) / g.dot(change) * change;
    by_position->keep_rate(g, possible);
    by_mass->keep_rate(g, change);
  }
}

}  // namespace sprung::dynamics

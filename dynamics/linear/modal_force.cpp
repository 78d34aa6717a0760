#include "dynamics/linear/modal_force.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kRoundingMargin = 4.0;    // the estimate of rounding is correct to a factor of a few
constexpr double kPushedStiffness = 1e-9;  // for a direction with force and no stiffness, of the largest one
constexpr double kNeutralForce = 1e-7;     // acceleration along a neutral direction, natural sizes/s²

}  // namespace

double largest_natural(const Model& model, const std::vector<int>& coordinates,
                       const Eigen::VectorXd& values) {
  double largest = 0.0;
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    largest = std::max(
        largest, std::abs(values[static_cast<Eigen::Index>(k)]) / model.coordinate_scale(coordinates[k]));
  }
  return largest;
}

ModalForce::ModalForce(const Model& model, const LinearisedSystem& system)
    : modes(calc_undamped_modes(system.stiffness, system.mass, system.stiffness_rounding)) {
  const Eigen::MatrixXd& V = modes.vectors;
  const std::vector<int>& independent = system.partition.independent;
  force = V.transpose() * system.force;
  const Eigen::VectorXd rounding = V.cwiseAbs().transpose() * system.force_rounding;
  const double largest_acceleration = largest_natural(model, independent, V * force);
  stiffest = std::max(modes.omega_squared.cwiseAbs().maxCoeff(), largest_acceleration / kLargestStep);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(force.size());
  for (Eigen::Index k = 0; k < force.size(); ++k) {
    const double push = std::max(std::abs(force[k]) - rounding[k], 0.0);
    const bool is_pushed = largest_natural(model, independent, V.col(k) * push) > kNeutralForce;
    is_neutral.push_back(modes.is_free(k) && !is_pushed);
    is_falling |= modes.is_free(k) && is_pushed;
    if (!is_neutral.back()) moved += V.col(k).cwiseAbs() * (rounding[k] / calc_stiffness(k));
  }
  rounding_step = kRoundingMargin * largest_natural(model, independent, moved);
}

bool ModalForce::is_held() const {
  for (Eigen::Index k = 0; k < force.size(); ++k) {
    if (!is_neutral[static_cast<std::size_t>(k)] && modes.omega_squared[k] < 0.0) return false;
  }
  return !is_falling;
}

double ModalForce::calc_stiffness(Eigen::Index k) const {
  return modes.is_free(k) ? kPushedStiffness * stiffest : std::abs(modes.omega_squared[k]);
}

Eigen::VectorXd ModalForce::calc_step(const Eigen::VectorXd& r, double damping) const {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(r.size());
  for (Eigen::Index k = 0; k < force.size(); ++k) {
    if (is_neutral[static_cast<std::size_t>(k)]) continue;
    step += modes.vectors.col(k) * (r[k] / (calc_stiffness(k) + damping));
  }
  return step;
}

}  // namespace sprung::dynamics

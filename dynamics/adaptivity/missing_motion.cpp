#include "dynamics/adaptivity/missing_motion.h"

#include <algorithm>
#include <cmath>

#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kNeutral = 1e-12;  // of the largest ω²: rounding

}  // namespace

MissingMotion::MissingMotion(const FullSmallMotion& motion) {
  const auto num_rows = static_cast<Eigen::Index>(2 * motion.num_points());
  accelerations_ = Eigen::VectorXd::Zero(num_rows);
  if (motion.motion().mass.rows() > 0) {
    add_vibrations(motion);
  } else {
    add_lone_modes(motion);
  }
  vibrations_.resize(responses_.size());
  vibration_accelerations_.setZero(static_cast<Eigen::Index>(responses_.size()));
  for (std::size_t i = 0; i < responses_.size(); ++i)
    neutral_ = std::max(neutral_, kNeutral * responses_.stiffness(i));
}

void MissingMotion::add_vibrations(const FullSmallMotion& motion) {
  const auto& [M, C, K] = motion.motion();
  const auto vibrations = support::solve_undamped(K, M);
  if (!vibrations) throw support::NumericalError("the modes of small motion were not found");
  const Eigen::MatrixXd& V = vibrations->vectors;
  for (Eigen::Index i = 0; i < V.cols(); ++i)
    responses_.add(std::max(0.0, vibrations->values[i]), std::max(0.0, 0.5 * V.col(i).dot(C * V.col(i))));
  of_modes_ = motion.modal_motion() * V;
  of_points_.resize(accelerations_.size(), V.cols());
  for (std::size_t i = 0; i < motion.num_points(); ++i)
    of_points_.middleRows<2>(static_cast<Eigen::Index>(2 * i)) = motion.reduced_motion(i) * V;
}

// Where small motion is not known each mode vibrates alone.
void MissingMotion::add_lone_modes(const FullSmallMotion& motion) {
  const auto num_modes = static_cast<Eigen::Index>(motion.modal_coordinates().size());
  of_modes_ = Eigen::MatrixXd::Zero(num_modes, num_modes);
  of_points_.resize(accelerations_.size(), num_modes);
  for (Eigen::Index j = 0; j < num_modes; ++j) {
    const int coordinate = motion.modal_coordinates()[static_cast<std::size_t>(j)];
    const auto place = motion.model().body_coordinate(coordinate);
    const Body& body = motion.model().bodies[static_cast<std::size_t>(place.body)];
    const Eigen::Index k = coordinate - body.first_coordinate - 3;
    const double mass = body.M_ff(k, k);
    responses_.add(body.stiffness(k, k) / mass, 0.5 * body.damping(k, k) / mass);
    of_modes_(j, j) = 1.0 / std::sqrt(mass);
    for (std::size_t i = 0; i < motion.num_points(); ++i) {
      of_points_.block<2, 1>(static_cast<Eigen::Index>(2 * i), j) =
          motion.point_motion(i).col(coordinate) / std::sqrt(mass);
    }
  }
}

void MissingMotion::update(double step, const Eigen::VectorXd& forces) {
  if (step > 0.0) responses_.prepare(step);
  driving_.noalias() = of_modes_.transpose() * forces;
  for (std::size_t i = 0; i < vibrations_.size(); ++i) {
    Vibration& one = vibrations_[i];
    const double force = driving_[static_cast<Eigen::Index>(i)];
    if (step > 0.0) responses_.advance(i, one.force, force, one.place, one.rate);
    if (!has_begun_ && responses_.stiffness(i) > neutral_) one.place = force / responses_.stiffness(i);
    one.force = force;
    vibration_accelerations_[static_cast<Eigen::Index>(i)] =
        force - 2.0 * responses_.decay(i) * one.rate - responses_.stiffness(i) * one.place;
  }
  has_begun_ = true;
  accelerations_.noalias() = of_points_ * vibration_accelerations_;
}

}  // namespace sprung::dynamics

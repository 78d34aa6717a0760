#include "dynamics/adaptivity/ringing.h"

#include <cmath>
#include <numbers>

#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kExactness = 0.01;  // of T
constexpr double kShortest = 1e-4;   // of the longest T: as good as at once

}  // namespace

Ringing::Ringing(const SmallMotion& motion, const std::vector<Point>& points) {
  const auto undamped = support::solve_undamped(motion.stiffness, motion.mass);
  if (!undamped) throw support::NumericalError("the modes of small motion were not found");
  omega_ = undamped->values.array().max(0.0).sqrt();
  Phi_ = undamped->vectors;
  reach_.resize(static_cast<Eigen::Index>(points.size()), omega_.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Matrix2Xd shapes = points[i].motion * Phi_;
    reach_.row(static_cast<Eigen::Index>(i)) = shapes.colwise().norm().array() / points[i].acceleration;
  }
}

double Ringing::calc_share(const Eigen::ArrayXd& accelerations) const {
  if (reach_.rows() == 0) return 0.0;
  return std::sqrt((reach_.rowwise() * accelerations.transpose()).square().rowwise().sum().maxCoeff());
}

double Ringing::calc_share_of_impulse(const Eigen::VectorXd& impulse) const {
  return calc_share(omega_ * (Phi_.transpose() * impulse).array());
}

double Ringing::calc_share_of_release(const Eigen::VectorXd& force, double time) const {
  const Eigen::ArrayXd slowness = ((omega_ * (time / std::numbers::pi)).square() - 1.0).max(1.0);
  return calc_share((Phi_.transpose() * force).array() / slowness);
}

double Ringing::calc_release_time(const Eigen::VectorXd& force, double share, double longest) const {
  if (reach_.rows() == 0) return longest;
  const auto is_enough = [&](double time) { return calc_share_of_release(force, time) <= share; };
  if (is_enough(0.0)) return 0.0;
  double low = kShortest * longest, high = longest;
  if (!is_enough(high)) return high;
  if (is_enough(low)) return low;
  while (high > (1.0 + kExactness) * low) {  // the share falls with T
    const double middle = std::sqrt(low * high);
    (is_enough(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace sprung::dynamics

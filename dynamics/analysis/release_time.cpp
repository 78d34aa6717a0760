#include "dynamics/analysis/release_time.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kExactness = 0.01;  // of T
constexpr double kShortest = 1e-4;   // of the longest: as good as at once

}  // namespace

double calc_release_time(const SmallMotion& motion, const Eigen::VectorXd& force,
                         const std::vector<ReleasedPoint>& points, double longest) {
  if (points.empty()) return longest;
  const Eigen::MatrixXd stiffness = 0.5 * (motion.stiffness + motion.stiffness.transpose());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> undamped(stiffness, motion.mass);
  if (undamped.info() != Eigen::Success) throw support::NumericalError("the modes of small motion were not found");
  const Eigen::ArrayXd omega = undamped.eigenvalues().array().max(0.0).sqrt();
  const Eigen::ArrayXd pushed = (undamped.eigenvectors().transpose() * force).array().abs();
  // Acceleration of each point (row) with each vibration (column), let go at once, of what is allowed.
  Eigen::ArrayXXd at_once(static_cast<Eigen::Index>(points.size()), omega.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Matrix2Xd shapes = points[i].motion * undamped.eigenvectors();
    at_once.row(static_cast<Eigen::Index>(i)) =
        shapes.colwise().norm().array() * pushed.transpose() / points[i].allowed_acceleration;
  }
  const auto is_enough = [&](double time) {
    const Eigen::ArrayXd left = ((omega * (time / std::numbers::pi)).square() - 1.0).max(1.0).inverse();
    return (at_once.rowwise() * left.transpose()).square().rowwise().sum().maxCoeff() <= 1.0;
  };
  if (is_enough(0.0)) return 0.0;
  if (!is_enough(longest)) return longest;
  // It falls with T: halved on the logarithm.
  double low = kShortest * longest, high = longest;
  if (is_enough(low)) return low;
  while (high > (1.0 + kExactness) * low) {
    const double middle = std::sqrt(low * high);
    (is_enough(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace sprung::dynamics

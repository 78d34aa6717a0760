#include "dynamics/adaptivity/missing_acceleration.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

MissingAccelerationRecord::MissingAccelerationRecord(const ModeIndicator& indicator)
    : motion_(indicator.small_motion()),
      forces_(static_cast<Eigen::Index>(indicator.num_modes())),
      points_(indicator.small_motion().num_points()) {}

void MissingAccelerationRecord::add(const ModeIndicator& indicator) {
  const double step = has_begun_ ? indicator.time() - time_ : 0.0;
  for (std::size_t j = 0; j < indicator.num_modes(); ++j)
    forces_[static_cast<Eigen::Index>(j)] = indicator.unbalanced_force(j);
  motion_.update(step, forces_);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Point& point = points_[i];
    const Eigen::Vector2d missing = motion_.accelerations().segment<2>(static_cast<Eigen::Index>(2 * i)),
                          present = indicator.sizes().present_acceleration(i);
    const Eigen::Array2d square = missing.array().square();
    point.missing_sum += 0.5 * step * (point.missing + square);
    point.present_sum += 0.5 * step * (point.present + present.squaredNorm());
    point.missing = square;
    point.present = present.squaredNorm();
    point.peak = std::max(point.peak, present.norm());
    point.changed_peak = std::max(point.changed_peak, (present + missing).norm());
  }
  length_ += step;
  time_ = indicator.time();
  has_begun_ = true;
}

MissingAcceleration MissingAccelerationRecord::find_worst(const ModeIndicator& indicator) const {
  MissingAcceleration worst;
  const std::vector<bool>& active = indicator.active();
  if (std::find(active.begin(), active.end(), false) == active.end()) return worst;
  const double least = indicator.sizes().least_acceleration();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& point = points_[i];
    MissingAcceleration found{.point = static_cast<int>(i),
                              .direction = point.missing_sum[1] > point.missing_sum[0] ? 1 : 0};
    if (length_ > 0.0) {
      const double reference = std::max(point.present_sum, length_ * least * least);
      found.rms_share = std::sqrt(point.missing_sum.sum() / reference);
    }
    found.peak_change = std::abs(point.changed_peak - point.peak) / std::max(point.peak, least);
    if (worst.point < 0 || found.worst() > worst.worst()) worst = found;
  }
  return worst;
}

void MissingAccelerationRecord::restore(support::ByteReader& bytes) {
  const std::size_t num_points = points_.size(), num_vibrations = motion_.num_vibrations();
  transfer(bytes, *this);
  if (points_.size() != num_points || motion_.num_vibrations() != num_vibrations)
    throw support::DamagedBytes();
}

}  // namespace sprung::dynamics

#include "dynamics/adaptivity/missing_acceleration.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kHardly = 1e-2;  // of the acceleration of the point that moves most
constexpr double kRest = 3e-4;    // of the smallest acceleration that counts: rounding, and errors of steps
constexpr double kMostGrowth = 1.0;  // ln of the factor by which small motion may grow over the run
constexpr double kSameTime = 1e-9;   // of times that differ by rounding

}  // namespace

MissingAccelerationRecord::MissingAccelerationRecord(const ModeIndicator& indicator, std::vector<int> points,
                                                     const MissingStart& start, double from, double to)
    : motion_(indicator.small_motion(), start),
      markers_(std::move(points)),
      from_(from),
      to_(to),
      growth_(motion_.growth() * to > kMostGrowth ? motion_.growth() : 0.0),
      sums_{.points = std::vector<Point>(markers_.size())} {}

double MissingAccelerationRecord::find_angle(std::size_t point, const ModeIndicator& indicator,
                                             const Eigen::VectorXd& q) const {
  const Model& model = indicator.small_motion().model();
  const Marker& marker = model.markers[static_cast<std::size_t>(markers_[point])];
  if (marker.body == kGround) return 0.0;
  return q[model.bodies[static_cast<std::size_t>(marker.body)].first_coordinate + 2];
}

void MissingAccelerationRecord::add(const ModeIndicator& indicator, const Eigen::VectorXd& forces,
                                    const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  const double now = indicator.time(), step = sums_.has_begun ? now - sums_.time : 0.0;
  if (growth_ == 0.0) motion_.update(step, forces, v);
  const double slack = kSameTime * std::abs(now);
  const bool is_judged = now >= from_ - slack && now <= to_ + slack;
  const double judged = is_judged ? std::min(step, std::max(0.0, now - from_)) : 0.0;
  for (std::size_t i = 0; i < sums_.points.size(); ++i) {
    Point& point = sums_.points[i];
    // What is missing turns with the body.
    const double angle = find_angle(i, indicator, q);
    if (!sums_.has_begun) point.start_angle = angle;
    const FrameRotation turned = FrameRotation::from_angle(angle - point.start_angle);
    const Eigen::Vector2d missing =
                              turned * motion_.accelerations().segment<2>(static_cast<Eigen::Index>(2 * i)),
                          present = indicator.sizes().present_acceleration(i);
    const Eigen::Array2d square = missing.array().square();
    point.missing_sum += 0.5 * judged * (point.missing + square);
    point.present_sum += 0.5 * judged * (point.present + present.squaredNorm());
    point.missing = square;
    point.present = present.squaredNorm();
    if (!is_judged) continue;
    point.peak = std::max(point.peak, present.norm());
    point.changed_peak = std::max(point.changed_peak, (present + missing).norm());
  }
  sums_.length += judged;
  sums_.time = now;
  sums_.has_begun = true;
  const std::vector<bool>& active = indicator.active();
  sums_.has_left_out |= std::find(active.begin(), active.end(), false) != active.end();
}

MissingAcceleration MissingAccelerationRecord::find_worst(const ModeIndicator& indicator) const {
  MissingAcceleration worst;
  if (!sums_.has_left_out) return worst;
  if (growth_ > 0.0) return {.growth = growth_};
  // A point that hardly moves beside the others, or is at rest, has these accelerations as its reference.
  double largest_sum = 0.0, largest_peak = 0.0;
  for (const Point& point : sums_.points) {
    largest_sum = std::max(largest_sum, point.present_sum);
    largest_peak = std::max(largest_peak, point.peak);
  }
  const double least = kRest * indicator.sizes().least_acceleration();
  const double least_sum = std::max(kHardly * kHardly * largest_sum, sums_.length * least * least);
  const double least_peak = std::max(kHardly * largest_peak, least);
  for (std::size_t i = 0; i < sums_.points.size(); ++i) {
    const Point& point = sums_.points[i];
    MissingAcceleration found{.point = static_cast<int>(i),
                              .direction = point.missing_sum[1] > point.missing_sum[0] ? 1 : 0};
    if (sums_.length > 0.0)
      found.rms_share = std::sqrt(point.missing_sum.sum() / std::max(point.present_sum, least_sum));
    found.peak_change = std::abs(point.changed_peak - point.peak) / std::max(point.peak, least_peak);
    if (worst.point < 0 || found.worst() > worst.worst()) worst = found;
  }
  return worst;
}

void MissingAccelerationRecord::restore(support::ByteReader& bytes) {
  const std::size_t num_points = sums_.points.size();
  transfer(bytes, *this);
  if (sums_.points.size() != num_points || !motion_.has_consistent_states()) throw support::DamagedBytes();
}

}  // namespace sprung::dynamics

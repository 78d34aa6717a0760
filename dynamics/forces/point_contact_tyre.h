#pragma once

#include "dynamics/forces/tyre.h"

namespace sprung::dynamics {

/// A wheel that touches the road in the point under its centre (forces, eq. 5). With the
/// penetration δ = radius − (y − h) and its rate δ̇ = h′ṡ − ẏ, the vertical force on the wheel is spring(δ) +
/// damping δ̇; a one-sided tyre never pulls and has none while δ ≤ 0. No horizontal force.
class PointContactTyre final : public Tyre {
 public:
  using Tyre::Tyre;

  ElementDescription describe() const override { return describe_as("point"); }
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_longest_step(const Instant& instant) const override;
  /// Of the spring's slope and the damper: F = N (F_s′ + iωc) (forces, eq. 11).
  void add_road_response(const Instant& instant, std::span<const int> branches, const RoadWave& wave,
                         std::span<WrenchGain> wrenches,
                         std::span<std::complex<double>> channels) const override;

  std::span<const Channel> channels() const override { return all_channels().first(5); }
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  struct Wheel;
  Wheel calc_wheel(const Instant& instant, std::span<const int> branches) const;
  ContactMeasures measure_contact(const Instant& instant, std::span<const int> branches) const override;
  double calc_front(const Instant& instant) const override { return road().distance(center(instant).r.x()); }
};

}  // namespace sprung::dynamics

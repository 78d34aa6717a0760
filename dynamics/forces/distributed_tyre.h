#pragma once

#include "dynamics/forces/tyre.h"

namespace sprung::dynamics {

/// A wheel that touches the road along a length of it, and so envelopes what is short (forces, eqs. 7–10).
/// The penetration δ is the one that gives the same overlap of the wheel's circle on level ground, where this
/// tyre is the point-contact tyre of the same spring; the pressure spring(δ) + damping δ̇ over the width on
/// level ground acts normal to the road wherever it touches. The force has a potential, hence a part along
/// the road: an edge holds the wheel back. Rolling resistance and traction are other elements' matter.
class DistributedTyre final : public Tyre {
 public:
  /// @param parameters  one_sided must be true: a length of road cannot pull
  DistributedTyre(std::string element_name, Parameters parameters, PlacedRoad road);

  ElementDescription describe() const override { return describe_as("distributed"); }
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_longest_step(const Instant& instant) const override;
  /// Of the mean height over what touches, and of how its edges move (forces, eqs. 12, 13).
  void add_road_response(const Instant& instant, std::span<const int> branches, const RoadWave& wave,
                         std::span<WrenchGain> wrenches,
                         std::span<std::complex<double>> channels) const override;

  std::span<const Channel> channels() const override { return all_channels(); }
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  struct Wheel;
  Wheel calc_wheel(const Instant& instant) const;
  ContactMeasures measure_contact(const Instant& instant, std::span<const int> branches) const override;
  /// Up to where the wheel reaches in its direction of travel.
  double calc_front(const Instant& instant) const override;
  int num_cells_;
};

}  // namespace sprung::dynamics

#pragma once

#include "dynamics/forces/force_element.h"
#include "dynamics/forces/wheel_overlap.h"
#include "dynamics/functions/piecewise_polynomial.h"
#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// A wheel that touches the road along a length of it, and so envelopes what is short (forces, eqs. 7–10).
/// The penetration δ is the one that gives the same overlap of the wheel's circle on level ground, where this
/// tyre is the point-contact tyre of the same spring; the pressure spring(δ) + damping δ̇ over the width on
/// level ground acts normal to the road wherever it touches. The force has a potential, hence a part along
/// the road: an edge holds the wheel back. Rolling resistance and traction are other elements' matter.
class DistributedTyre final : public ForceElement {
 public:
  struct Parameters {
    int marker = 0;              ///< wheel centre
    double radius = 0.0;         ///< > 0 [m]
    double multiplicity = 1.0;   ///< wheels on the axle, > 0
    PiecewisePolynomial spring;  ///< F(δ) on level ground [N], 0 at δ = 0
    double damping = 0.0;        ///< ≥ 0 [N·s/m]
  };
  DistributedTyre(std::string element_name, Parameters parameters, PlacedRoad road);

  std::string_view kind() const override { return "tyre"; }
  std::vector<int> markers() const override { return {parameters_.marker}; }
  ElementDescription describe() const override;
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const override;

  /// Branches: kind of contact (0 in the air, 1 pressed, 2 touching without force), segment of the road that
  /// the wheel's front is on.
  int num_branches() const override { return 2; }
  void choose_branches(const Instant& instant, std::span<int> branches) const override;
  /// Switches: depth of contact, force, the segment's two ends.
  int num_switches() const override { return 4; }
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;
  std::string describe_change(std::span<const int> old_branches,
                              std::span<const int> new_branches) const override;
  double calc_longest_step(const Instant& instant) const override;

  std::optional<RoadPlace> find_road_place(const Instant& instant,
                                           std::span<const int> branches) const override;
  /// Of the mean height over what touches, and of how its edges move (forces, eqs. 12, 13).
  void add_road_response(const Instant& instant, std::span<const int> branches, const RoadWave& wave,
                         std::span<WrenchGain> wrenches,
                         std::span<std::complex<double>> channels) const override;

  std::span<const Channel> channels() const override;
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  struct Wheel;
  Wheel calc_wheel(const Instant& instant) const;
  double front(const Instant& instant) const;  // distance along the road that the wheel reaches to
  Parameters parameters_;
  PlacedRoad road_;
  int num_cells_;
  double dead_band_ = 0.0;  // [N]
};

}  // namespace sprung::dynamics

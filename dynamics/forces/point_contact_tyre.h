#pragma once

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/piecewise_polynomial.h"
#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// A wheel that touches the road in the point under its centre (forces, eq. 5). With the
/// penetration δ = radius − (y − h) and its rate δ̇ = h′ṡ − ẏ, the vertical force on the wheel is spring(δ) +
/// damping δ̇; a one-sided tyre never pulls and has none while δ ≤ 0. No horizontal force.
class PointContactTyre final : public ForceElement {
 public:
  struct Parameters {
    int marker = 0;              ///< wheel centre
    double radius = 0.0;         ///< > 0 [m]
    double multiplicity = 1.0;   ///< wheels on the axle, > 0
    PiecewisePolynomial spring;  ///< F(δ) [N], 0 at δ = 0
    double damping = 0.0;        ///< ≥ 0 [N·s/m]
    bool one_sided = true;
  };
  PointContactTyre(std::string element_name, Parameters parameters, PlacedRoad road);

  const Parameters& parameters() const { return parameters_; }
  const PlacedRoad& road() const { return road_; }
  std::string_view kind() const override { return "tyre"; }
  std::vector<int> markers() const override { return {parameters_.marker}; }
  ElementDescription describe() const override;
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const override;

  /// Branches: kind of contact (0 in the air, 1 pressed, 2 touching without force), segment of the road.
  int num_branches() const override { return 2; }
  void choose_branches(const Instant& instant, std::span<int> branches) const override;
  /// Switches: penetration, force, the segment's two ends.
  int num_switches() const override { return 4; }
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;
  std::string describe_change(std::span<const int> old_branches,
                              std::span<const int> new_branches) const override;
  double calc_longest_step(const Instant& instant) const override;

  std::optional<RoadPlace> find_road_place(const Instant& instant,
                                           std::span<const int> branches) const override;
  /// Of the spring's slope and the damper: F = N (F_s′ + iωc) (forces, eq. 11).
  void add_road_response(const Instant& instant, std::span<const int> branches, const RoadWave& wave,
                         std::span<WrenchGain> wrenches,
                         std::span<std::complex<double>> channels) const override;

  std::span<const Channel> channels() const override;
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  struct Wheel;
  Wheel calc_wheel(const Instant& instant, std::span<const int> branches) const;
  Parameters parameters_;
  PlacedRoad road_;
  double dead_band_ = 0.0;  // [N]
};

}  // namespace sprung::dynamics

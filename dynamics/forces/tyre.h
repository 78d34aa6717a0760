#pragma once

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/piecewise_polynomial.h"
#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// A wheel with spring and damper on the road: what the two kinds of tyre, which touch the road in a point
/// and along a length of it, have in common.
///
/// Branches: kind of contact (0 in the air, 1 pressed, 2 touching without force), segment of the road.
/// Switches: depth of contact, force, the segment's two ends.
class Tyre : public ForceElement {
 public:
  struct Parameters {
    int marker = 0;              ///< wheel centre
    double radius = 0.0;         ///< > 0 [m]
    double multiplicity = 1.0;   ///< wheels on the axle, > 0
    PiecewisePolynomial spring;  ///< F(δ) on level ground [N], 0 at δ = 0
    double damping = 0.0;        ///< ≥ 0 [N·s/m]
    bool one_sided = true;       ///< false: never leaves the ground, and pulls where δ < 0
  };
  Tyre(std::string element_name, Parameters parameters, PlacedRoad road);

  const Parameters& parameters() const { return parameters_; }
  const PlacedRoad& road() const { return road_; }
  std::string_view kind() const final { return "tyre"; }
  std::vector<int> markers() const final { return {parameters_.marker}; }
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const final;
  std::vector<DeflectionLaw> deflection_laws() const final { return {{1, &parameters_.spring}}; }

  int num_branches() const final { return 2; }
  void choose_branches(const Instant& instant, std::span<int> branches) const final;
  int num_switches() const final { return 4; }
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const final;
  std::string describe_change(std::span<const int> old_branches,
                              std::span<const int> new_branches) const final;
  std::optional<RoadPlace> find_road_place(const Instant& instant, std::span<const int> branches) const final;

 protected:
  enum Contact : int { kInAir = 0, kPressed = 1, kTouching = 2 };

  /// What decides about the kind of contact.
  struct ContactMeasures {
    double penetration;  ///< δ [m]
    double depth;        ///< how deep the road stands in the wheel; negative in the air [m]
    double depth_rate;   ///< [m/s]
    double force;        ///< of spring and damper on one wheel, as if it were pressed [N]
  };
  virtual ContactMeasures measure_contact(const Instant& instant, std::span<const int> branches) const = 0;
  /// The place whose segment of the road is the branch: distance along the road [m].
  virtual double calc_front(const Instant& instant) const = 0;

  const MarkerState& center(const Instant& instant) const {
    return instant.markers[static_cast<std::size_t>(parameters_.marker)];
  }
  /// Time in which the wheel passes a length of road [s]; infinite where it stands still.
  double calc_passing_time(const Instant& instant, double length) const;
  /// @param contact  value of the parameter `contact`
  ElementDescription describe_as(const char* contact) const;
  /// Force, penetration, rate, contact, height of the road and, of which a kind may do without, the
  /// longitudinal force.
  static std::span<const Channel> all_channels();

 private:
  Parameters parameters_;
  PlacedRoad road_;
  double dead_band_;  // [N]
};

}  // namespace sprung::dynamics

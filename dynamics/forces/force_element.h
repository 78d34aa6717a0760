#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/bodies/marker.h"
#include "dynamics/description/element_description.h"
#include "dynamics/forces/road_response.h"
#include "dynamics/functions/time_function.h"

namespace sprung::dynamics {

/// Force and torque on a marker, world axes.
struct Wrench {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();  ///< [N]
  double torque = 0.0;                              ///< [N·m]
};

/// What a force element sees of the vehicle at one instant.
struct Instant {
  double time = 0.0;                     ///< [s]
  std::span<const MarkerState> markers;  ///< all of the model's
};

/// Power that leaves (dissipated) or enters (input) the mechanical energy through a force element [W].
struct Power {
  double dissipated = 0.0;
  double input = 0.0;
};

/// What a channel says, for readers that do not know the element.
enum class ChannelRole {
  kForce,              ///< force that the element exerts: along its line, or the vertical one on a wheel
  kLongitudinalForce,  ///< horizontal force on a wheel
  kTorque,             ///< torque that it exerts
  kGiven,              ///< force or torque that the input file gives as a function of time
  kExtent,             ///< length, or angle, between its points
  kDeflection,         ///< what a spring's law depends on: compression, penetration
  kRate,               ///< rate of that deflection
  kContact,            ///< 1 while a wheel touches the road, else 0
  kRoadHeight,         ///< height of the road under a wheel
};

/// A column of a force element's results.
struct Channel {
  std::string_view name;
  std::string_view unit;
  ChannelRole role;
};

/// As in results files: "road-height".
std::string_view role_name(ChannelRole role);

/// A force between markers, or on one. Open to new kinds: the solver knows no more than this.
///
/// Where its law jumps or changes formula, an element declares *branches*: integers that say which smooth
/// formula is in use. Within a step they stay fixed, so that the integrator sees a smooth function even
/// beyond the switch; the zero of a *switch function* is located and the branches are chosen anew there.
class ForceElement {
 public:
  explicit ForceElement(std::string element_name) : name(std::move(element_name)) {}
  virtual ~ForceElement() = default;

  virtual std::string_view kind() const = 0;
  /// The markers that it sees.
  virtual std::vector<int> markers() const = 0;
  /// Its points in the order of markers(), and what it was made with.
  virtual ElementDescription describe() const = 0;

  /// Adds the element's wrenches on its markers.
  /// @param branches  the element's own, as chosen last
  /// @param wrenches  one per marker of the model, added to
  virtual Power add_wrenches(const Instant& instant, std::span<const int> branches,
                             std::span<Wrench> wrenches) const = 0;

  /// Energy stored [J]; its change is minus the work done by what add_wrenches neither dissipates nor puts
  /// in.
  virtual double calc_stored_energy(const Instant& /*instant*/, std::span<const int> /*branches*/) const {
    return 0.0;
  }

  virtual int num_branches() const { return 0; }
  virtual void choose_branches(const Instant& /*instant*/, std::span<int> /*branches*/) const {}
  virtual int num_switches() const { return 0; }
  /// @param[out] values  positive while the branches hold, negative beyond; smooth in time
  virtual void calc_switches(const Instant& /*instant*/, std::span<const int> /*branches*/,
                             std::span<double> /*values*/) const {}
  /// What a change of branches means, for the list of events: "touches the ground"; "" where it is not worth
  /// telling.
  virtual std::string describe_change(std::span<const int> /*old_branches*/,
                                      std::span<const int> /*new_branches*/) const {
    return {};
  }

  /// How far the integrator may go in one step without missing something that the element knows is coming
  /// [s].
  virtual double calc_longest_step(const Instant& /*instant*/) const {
    return std::numeric_limits<double>::infinity();
  }

  /// Where it stands on the road; none for an element that does not see the road.
  virtual std::optional<RoadPlace> find_road_place(const Instant& /*instant*/,
                                                   std::span<const int> /*branches*/) const {
    return std::nullopt;
  }
  /// What low waves of the road do to it while the vehicle keeps still about its place, on level ground: the
  /// linear part of wrenches and channels, for an amplitude of 1 m. Called for elements that are pressed to
  /// the road only.
  /// @param wrenches  one per marker of the model, added to
  /// @param channels  one per channel [its unit/m], set
  virtual void add_road_response(const Instant& /*instant*/, std::span<const int> /*branches*/,
                                 const RoadWave& /*wave*/, std::span<WrenchGain> /*wrenches*/,
                                 std::span<std::complex<double>> /*channels*/) const {}

  /// The functions of time in it, whose breaks the integrator has to step to.
  virtual std::vector<const TimeFunction*> time_functions() const { return {}; }

  virtual std::span<const Channel> channels() const = 0;
  virtual void calc_channels(const Instant& instant, std::span<const int> branches,
                             std::span<double> values) const = 0;

  const std::string name;
};

}  // namespace sprung::dynamics

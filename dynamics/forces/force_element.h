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
#include "dynamics/functions/piecewise_polynomial.h"
#include "dynamics/functions/time_function.h"

namespace sprung::dynamics {

/// Force and torque on a marker, world axes.
struct Wrench {
  Eigen::Vector2d force = Eigen::Vector2d::Zero();  ///< [N]
  double torque = 0.0;                              ///< [N·m]
};

/// Time, the motion of the vehicle's markers and the element's own states: all that a force depends on.
struct Instant {
  double time = 0.0;                     ///< [s]
  std::span<const MarkerState> markers;  ///< all markers of the model
  std::span<const double> states = {};   ///< internal states of the element that is asked [J^0.5]
  /// Slopes of linear laws in the place of those of its damper forces over their rates, one for each channel
  /// of a rate; empty: its own laws. @see ForceElement::linearise_for_random_motion
  std::span<const double> rate_slopes = {};
};

/// A quantity of a force element that changes at a rate of its own, ż = g: a history of its motion (system,
/// eq. 14). It is zero at rest and scaled so that ½z² is an energy.
struct InternalState {
  std::string name;  ///< "relaxation_x"
  /// Its natural size [J^0.5], or [J^0.5/m] of the model's length scale. The linearisation takes differences
  /// over a thousandth of it.
  double size = 1.0;
  bool is_per_length = false;
};

/// A linear law in the place of that of an element's n states: their rates are `gain` times those which
/// motion from rest gives them, less `decay` times the states.
struct StateLinearisation {
  Eigen::VectorXd gain;   ///< n, one factor for each state
  Eigen::MatrixXd decay;  ///< n×n [1/s]
};

/// Linear laws in the place of those of an element that are far from linear; empty where there are none.
struct RandomLaws {
  std::optional<StateLinearisation> states = {};
  /// Of damper forces over their rates: one for each channel of a rate, or none [N·s/m or N·m·s/rad].
  std::vector<double> rate_slopes = {};

  bool is_empty() const { return !states && rate_slopes.empty(); }
};

/// What a force depends on by a deflection of its element, and a linear vehicle has the slope at rest of.
struct DeflectionLaw {
  std::size_t channel = 0;                      ///< of the deflection
  const PiecewisePolynomial* law = nullptr;     ///< of the element, with its stops; null: it is a stop alone
  std::optional<double> compression_stop = {};  ///< deflection from which on a stop acts [m or rad]
  std::optional<double> rebound_stop = {};      ///< deflection up to which a stop acts
};

/// Power by which a force element reduces (dissipated) or increases (input) the mechanical energy [W].
struct Power {
  double dissipated = 0.0;
  double input = 0.0;
};

/// The meaning of a channel, for readers that do not know the element.
enum class ChannelRole {
  kForce,              ///< force that the element exerts: along its line or an axis, or vertical on a wheel
  kLongitudinalForce,  ///< horizontal force on a wheel
  kTorque,             ///< torque that the element exerts
  kGiven,              ///< force or torque that the input file gives as a function of time
  kExtent,             ///< length or angle between the element's points
  kDeflection,         ///< argument of a spring's law: compression, penetration
  kRate,               ///< rate of that deflection
  kContact,            ///< 1 while a wheel touches the road, else 0
  kRoadHeight,         ///< height of the road under a wheel
  kPressure,           ///< pressure of a gas, or a difference of two
  kMass,               ///< mass of a gas
  kMassFlow,           ///< mass of gas that enters per time
};

/// One quantity among a force element's results.
struct Channel {
  std::string_view name;
  std::string_view unit;
  ChannelRole role;
};

/// The name of a role in results files: "road-height".
std::string_view role_name(ChannelRole role);

/// A force between markers, or on one marker. This interface is all that the solver knows about forces, so
/// that new kinds can be added.
///
/// If the law of an element jumps or changes its formula, the element has *branches*: integers that say which
/// smooth formula is in use. They stay fixed within a step, so that the integrator sees a smooth function
/// even beyond the switch. The zero of a *switch function* is located, and the branches are chosen anew
/// there.
class ForceElement {
 public:
  explicit ForceElement(std::string element_name) : name(std::move(element_name)) {}
  virtual ~ForceElement() = default;

  virtual std::string_view kind() const = 0;
  /// The markers that the force depends on or acts on.
  virtual std::vector<int> markers() const = 0;
  /// Those on which it may exert a torque: all, for an element with a channel whose role is kTorque.
  virtual std::vector<int> turned_markers() const;
  /// Its points in the order of markers(), and its parameters.
  virtual ElementDescription describe() const = 0;

  /// Adds the element's wrenches on its markers.
  /// @param branches  of the element, as chosen last
  /// @param[in,out] wrenches  one for each marker of the model
  virtual Power add_wrenches(const Instant& instant, std::span<const int> branches,
                             std::span<Wrench> wrenches) const = 0;

  /// Energy stored [J]. Its rate is minus the power of the wrenches, minus the power dissipated, plus the
  /// power put in (see add_wrenches).
  virtual double calc_stored_energy(const Instant& /*instant*/, std::span<const int> /*branches*/) const {
    return 0.0;
  }

  /// The states whose rates `calc_state_rates` gives.
  virtual std::vector<InternalState> internal_states() const { return {}; }
  /// @param[out] rates  ż, one for each internal state; zero where markers and states are at rest, except
  ///                    through a valve that is open there
  virtual void calc_state_rates(const Instant& /*instant*/, std::span<const int> /*branches*/,
                                std::span<double> /*rates*/) const {}

  /// Its laws for random motion about rest: of its states, where their own law is far from linear near rest,
  /// as that of friction, and of its dampers, where one has more than one slope.
  /// @param rms  root mean square of each channel, 0 of contact and road height; empty: of a motion that is
  ///             usual for such an element
  virtual RandomLaws linearise_for_random_motion(const Instant& /*at_rest*/,
                                                 std::span<const int> /*branches*/,
                                                 std::span<const double> /*rms*/) const {
    return {};
  }

  /// The laws of its springs.
  virtual std::vector<DeflectionLaw> deflection_laws() const { return {}; }

  virtual int num_branches() const { return 0; }
  /// @param[in,out] branches  those in use, all 0 at the start of a run. A branch stays in use up to half a
  /// dead band beyond its end, so that rounding does not switch it back and forth.
  virtual void choose_branches(const Instant& /*instant*/, std::span<int> /*branches*/) const {}
  virtual int num_switches() const { return 0; }
  /// @param[out] values  positive while the branches hold, zero a dead band beyond their end, then negative;
  /// smooth in time; 1 for a switch that is not in use
  virtual void calc_switches(const Instant& /*instant*/, std::span<const int> /*branches*/,
                             std::span<double> /*values*/) const {}
  /// What a change of branches means, for the list of events: "touches the ground"; "" if it is not an event
  /// for that list, such as a stop that is reached.
  virtual std::string describe_change(std::span<const int> /*old_branches*/,
                                      std::span<const int> /*new_branches*/) const {
    return {};
  }

  /// Longest step that cannot pass over a change of the force unseen, as far as the element knows [s]: for an
  /// element on a road, or with a function of time. Switch functions are watched without it.
  virtual double calc_longest_step(const Instant& /*instant*/) const {
    return std::numeric_limits<double>::infinity();
  }

  /// Its position on the road; none for an element that does not depend on the road.
  virtual std::optional<RoadPlace> find_road_place(const Instant& /*instant*/,
                                                   std::span<const int> /*branches*/) const {
    return std::nullopt;
  }
  /// The response of wrenches and channels to a road wave, linearised about level ground with the markers at
  /// rest relative to the steady motion, for an amplitude of 1 m. It is called only while the element is
  /// pressed to the road.
  /// @param[in,out] wrenches  one for each marker of the model, to which the element's are added
  /// @param[out] channels  one for each channel [its unit/m]
  virtual void add_road_response(const Instant& /*instant*/, std::span<const int> /*branches*/,
                                 const RoadWave& /*wave*/, std::span<WrenchGain> /*wrenches*/,
                                 std::span<std::complex<double>> /*channels*/) const {}

  /// The functions of time that it depends on; the integrator steps to each of their breaks.
  virtual std::vector<const TimeFunction*> time_functions() const { return {}; }

  virtual std::span<const Channel> channels() const = 0;
  /// Place of its first channel of a role among channels(); none if it has no such channel.
  std::optional<std::size_t> find_channel(ChannelRole role) const;
  /// @param branches  of the element, as for add_wrenches
  virtual void calc_channels(const Instant& instant, std::span<const int> branches,
                             std::span<double> values) const = 0;

  const std::string name;
};

}  // namespace sprung::dynamics

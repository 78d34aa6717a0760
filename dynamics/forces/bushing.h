#pragma once

#include <array>

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A bushing between two markers a and b (forces, eqs. 15–18): two forces and a torque that depend on where b
/// is as seen from a, in axes that turn with a. In each of the three directions a spring and a damper act
/// against the deflection u, and where it is asked for a spring in series with a damper, which relaxes. The
/// internal states belong to these.
///
/// Branches: the pieces in use of the six laws. Switches: the ends of these pieces.
class Bushing final : public ForceElement {
 public:
  /// The laws of one direction.
  struct Direction {
    PiecewisePolynomial spring = {};  ///< F_s(u) [N or N·m]
    PiecewisePolynomial damper = {};  ///< F_d(u̇) [N or N·m]
    /// A spring in series with a damper: stiffness k_r, 0 without it [N/m or N·m/rad], and τ [s].
    double relaxing_stiffness = 0.0, relaxation_time = 1.0;
  };
  struct Parameters {
    int marker_a = 0;
    int marker_b = 0;
    double angle = 0.0;                                       ///< of the axis x against the axes of a [rad]
    Eigen::Vector2d free_position = Eigen::Vector2d::Zero();  ///< of b, in these axes [m]
    double free_angle = 0.0;                                  ///< of b against a [rad]
    double multiplicity = 1.0;                                ///< number of them side by side, > 0
    std::array<Direction, 3> directions = {};                 ///< x, y, rotation
  };
  Bushing(std::string element_name, Parameters parameters);

  const Parameters& parameters() const { return parameters_; }
  std::string_view kind() const override { return "bushing"; }
  std::vector<int> markers() const override { return {parameters_.marker_a, parameters_.marker_b}; }
  std::vector<int> turned_markers() const override;
  ElementDescription describe() const override;
  std::vector<DeflectionLaw> deflection_laws() const override;
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const override;

  std::vector<InternalState> internal_states() const override;
  void calc_state_rates(const Instant& instant, std::span<const int> branches,
                        std::span<double> rates) const override;

  RandomLaws linearise_for_random_motion(const Instant& at_rest, std::span<const int> branches,
                                         std::span<const double> rms) const override;

  int num_branches() const override { return 6; }
  void choose_branches(const Instant& instant, std::span<int> branches) const override;
  int num_switches() const override { return num_switches_; }
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

  std::span<const Channel> channels() const override;
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  struct Relative;
  Relative calc_relative(const Instant& instant) const;
  double calc_state_factor(std::size_t direction) const;
  Parameters parameters_;
  int num_switches_ = 0;
  std::vector<std::size_t> relaxing_;  // direction of each internal state
};

}  // namespace sprung::dynamics

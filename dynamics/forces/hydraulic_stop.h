#pragma once

#include <array>

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A hydraulic end stop between two markers (forces, eq. 14). It is out of contact while they are further
/// apart than the contact length. The overlap δ = contact length − length is positive in contact. Then a
/// force pushes the markers apart; it never pulls. Oil that is pressed through the metering orifice resists
/// with the square of the speed; a check valve lets it back without resistance.
///
/// Branches: kind of contact, pieces of the spring's law and of the metering, sign of the rate. Switches:
/// overlap, force, the ends of the pieces, the rate.
class HydraulicStop final : public ForceElement {
 public:
  struct Parameters {
    int marker_a = 0;
    int marker_b = 0;
    double contact_length = 0.0;   ///< > 0 [m]
    PiecewisePolynomial spring;    ///< F_s(δ) [N]
    PiecewisePolynomial metering;  ///< c_h(δ) ≥ 0 [N·s²/m²]
    double damping = 0.0;          ///< c ≥ 0 [N·s/m²]
  };
  HydraulicStop(std::string element_name, Parameters parameters);

  const Parameters& parameters() const { return parameters_; }
  std::string_view kind() const override { return "hydraulic-stop"; }
  std::vector<int> markers() const override { return {parameters_.marker_a, parameters_.marker_b}; }
  ElementDescription describe() const override;
  std::vector<DeflectionLaw> deflection_laws() const override {
    return {{.channel = 1, .compression_stop = 0.0}};
  }
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const override;

  RandomLaws linearise_for_random_motion(const Instant& at_rest, std::span<const int> branches,
                                         std::span<const double> rms) const override;

  int num_branches() const override { return 4; }
  void choose_branches(const Instant& instant, std::span<int> branches) const override;
  int num_switches() const override {
    return 3 + parameters_.spring.num_switches() + parameters_.metering.num_switches();
  }
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

  std::span<const Channel> channels() const override;
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  enum Contact : int { kApart = 0, kPushing = 1, kWithoutForce = 2 };
  enum Flow : int { kThroughOrifice = 0, kThroughValve = 1 };
  struct Line;
  struct Law;
  Line calc_line(const Instant& instant) const;
  Law calc_law(const Line& line, std::span<const int> branches) const;
  Parameters parameters_;
  double force_dead_band_;  // [N]
};

}  // namespace sprung::dynamics

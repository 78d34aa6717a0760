#pragma once

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A leaf spring along the line between two markers (forces, eqs. 19–21): an elastic law over the deflection
/// d = free length − length, and the friction between its leaves. Friction needs a path to build up: behind
/// a reversal it approaches its full value by 1 − 1/e in each further distance β. At rest it holds whatever
/// it has reached. The internal state is the friction's share of its full value.
/// Source: [Fancher 1980]
///
/// Branches: the pieces in use of the elastic law and of the friction, sign of the rate. Switches: the ends
/// of the pieces, the rate.
class LeafSpring final : public ForceElement {
 public:
  struct Parameters {
    int marker_a = 0;
    int marker_b = 0;
    double free_length = 0.0;            ///< > 0 [m]
    double multiplicity = 1.0;           ///< number of them side by side, > 0
    PiecewisePolynomial spring = {};     ///< F_s(d) [N]
    PiecewisePolynomial friction = {};   ///< F_c(d), full friction, > 0 somewhere and ≥ 0 [N]
    double presliding_deflection = 1.0;  ///< β > 0 [m]
  };
  LeafSpring(std::string element_name, Parameters parameters);

  const Parameters& parameters() const { return parameters_; }
  std::string_view kind() const override { return "leaf-spring"; }
  std::vector<int> markers() const override { return {parameters_.marker_a, parameters_.marker_b}; }
  ElementDescription describe() const override;
  std::vector<DeflectionLaw> deflection_laws() const override { return {{1, &parameters_.spring}}; }
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  double calc_stored_energy(const Instant& instant, std::span<const int> branches) const override;
  std::vector<InternalState> internal_states() const override;
  void calc_state_rates(const Instant& instant, std::span<const int> branches,
                        std::span<double> rates) const override;
  RandomLaws linearise_for_random_motion(const Instant& at_rest, std::span<const int> branches,
                                         std::span<const double> rms) const override;

  int num_branches() const override { return 3; }
  void choose_branches(const Instant& instant, std::span<int> branches) const override;
  int num_switches() const override {
    return 1 + parameters_.spring.num_switches() + parameters_.friction.num_switches();
  }
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

  std::span<const Channel> channels() const override;
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  enum Motion : int { kCompressing = 0, kExtending = 1 };
  struct Line;
  Line calc_line(const Instant& instant) const;
  Parameters parameters_;
  double full_state_;  // z where the friction is full [J^0.5]
};

}  // namespace sprung::dynamics

#pragma once

#include <optional>

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A spring and a damper in parallel, functions of one deflection and of its rate: what the two kinds, along
/// a line and between angles, have in common. Branches: the pieces in use of spring and damper. Switches: the
/// ends of these pieces.
class SpringAndDamper : public ForceElement {
 public:
  using ForceElement::ForceElement;

  RandomLaws linearise_for_random_motion(const Instant& at_rest, std::span<const int> branches,
                                         std::span<const double> rms) const final;

  int num_branches() const final { return 2; }
  void choose_branches(const Instant& instant, std::span<int> branches) const final;
  int num_switches() const final { return spring().num_switches() + damper().num_switches(); }
  void calc_switches(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const final;

 protected:
  struct Deflection {
    double value;  ///< d [m or rad]
    double rate;   ///< ḋ
  };
  /// Units of the arguments and values of the two laws.
  struct Units {
    const char *deflection, *rate, *force;
  };
  /// Adds the parameters that both kinds have: multiplicity, laws, stops.
  template <typename Parameters>
  static void describe_laws(const Units& units, const Parameters& parameters,
                            ElementDescription& description) {
    std::vector<Parameter>& list = description.parameters;
    list.push_back({"multiplicity", parameters.multiplicity, "1"});
    list.push_back({"spring", parameters.spring, units.force, units.deflection});
    list.push_back({"damper", parameters.damper, units.force, units.rate});
    if (parameters.compression_stop) {
      list.push_back({"compression_stop", *parameters.compression_stop, units.deflection});
    }
    if (parameters.rebound_stop) list.push_back({"rebound_stop", *parameters.rebound_stop, units.deflection});
  }
  virtual Deflection calc_deflection(const Instant& instant) const = 0;
  virtual const PiecewisePolynomial& spring() const = 0;
  virtual const PiecewisePolynomial& damper() const = 0;
  virtual double multiplicity() const = 0;
  /// Of the dampers side by side. @param branch  of the damper
  double calc_damper_force(const Instant& instant, int branch, double rate) const;
  /// The same, where it is not known which piece is in use.
  double calc_damper_force(const Instant& instant, double rate) const;
};

}  // namespace sprung::dynamics

#pragma once

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A spring and a damper side by side, functions of one deflection and of its rate: what the two kinds of
/// them, along a line and between angles, have in common. Branches: pieces of spring and damper. Switches:
/// the ends of both, where they have any.
class SpringAndDamper : public ForceElement {
 public:
  using ForceElement::ForceElement;

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
  virtual Deflection calc_deflection(const Instant& instant) const = 0;
  virtual const PiecewisePolynomial& spring() const = 0;
  virtual const PiecewisePolynomial& damper() const = 0;
};

}  // namespace sprung::dynamics

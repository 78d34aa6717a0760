#pragma once

#include <span>

#include "dynamics/forces/passage.h"
#include "dynamics/forces/piecewise_polynomial.h"

namespace sprung::dynamics {

/// The laws of a spring and a damper that act side by side, seen as pieces: a function of the deflection and
/// one of its rate. Branches: the pieces in use, 2. Switches: the ends of both, where they have any.
struct SpringAndDamper {
  const PiecewisePolynomial& spring;
  const PiecewisePolynomial& damper;

  void choose_branches(double deflection, double rate, std::span<int> branches) const;
  int num_switches() const { return spring.num_switches() + damper.num_switches(); }
  void calc_switches(double deflection, double rate, std::span<const int> branches,
                     std::span<double> values) const;
  Passage passage(int switch_index, std::span<const int> branches) const;
  void go_beyond(int switch_index, std::span<int> branches) const;
};

}  // namespace sprung::dynamics

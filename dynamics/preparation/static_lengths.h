#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A force element that has the length of the vehicle file in static equilibrium.
struct StaticLengthResult {
  std::string force;
  double length = 0.0;                        ///< in equilibrium [m]
  std::optional<double> free_length = {};     ///< that gives it [m]
  std::optional<double> gauge_pressure = {};  ///< of an air spring, that gives it [Pa]
};

/// Finds the free lengths of the springs whose length in static equilibrium the vehicle file gives, and the
/// pressures of such air springs, and writes them into the vehicle. The search starts from the loads of the
/// vehicle with these springs held at their lengths. Broyden's method: the inverse Jacobian starts as the
/// identity, which is exact where each spring carries a load that does not depend on the others. Linear
/// springs stand in for air springs; their forces in equilibrium give the pressures.
/// @param make_balance  the model for the balance, of a vehicle with other free lengths
/// @throws support::InputError at a force whose static length cannot be reached together with the others;
///         support::NumericalError if there is no equilibrium
/// Checked by tests/dynamics/program/static_length_test.py
std::vector<StaticLengthResult> solve_static_lengths(
    Vehicle& vehicle, const std::function<Model(const Vehicle&)>& make_balance);

}  // namespace sprung::dynamics

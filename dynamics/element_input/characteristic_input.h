#pragma once

#include <string_view>

#include "dynamics/functions/piecewise_polynomial.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Units of a force law, for messages: of a spring-damper along a line, or about an axis.
struct LawUnits {
  std::string_view deflection, rate, force, coefficient, stiffness, damping;
};
inline constexpr LawUnits kTranslation{.deflection = "m",
                                       .rate = "m/s",
                                       .force = "N",
                                       .coefficient = "N/m^k",
                                       .stiffness = "N/m",
                                       .damping = "N·s/m"};
inline constexpr LawUnits kRotation{.deflection = "rad",
                                    .rate = "rad/s",
                                    .force = "N·m",
                                    .coefficient = "N·m/rad^k",
                                    .stiffness = "N·m/rad",
                                    .damping = "N·m·s/rad"};

/// Reads the law of a spring, F(d) in N over the deflection d in m, positive in compression:
///
///     { polynomial = [a_0, a_1, …] }       F = Σ a_k d^k
///     { table = [[d, F], …] }              straight lines through the points
///
/// @throws support::InputError also for a negative stiffness at d = 0
/// Checked by tests/dynamics/element_input/force_input_test.cpp
PiecewisePolynomial read_spring(const support::TomlTable& table, const LawUnits& units = kTranslation);

/// Reads a stop, { deflection, rate }, and adds it to a spring's law: beyond that deflection, above it for
/// compression and below it for rebound, the force is linear with the slope `rate` > 0 [N/m].
/// @param[in,out] spring  from read_spring
/// @return the deflection where the stop begins [m]
/// Checked by tests/dynamics/element_input/force_input_test.cpp
double read_stop(const support::TomlTable& table, bool rebound, PiecewisePolynomial& spring,
                 const LawUnits& units = kTranslation);

/// Reads the law of a damper, F(ḋ) in N over the rate of deflection ḋ in m/s, positive in compression:
///
///     { coefficient = c }                          F = c ḋ
///     { compression = c_1, rebound = c_2 }         F = c_1 ḋ for ḋ > 0, c_2 ḋ for ḋ < 0
///     { table = [[ḋ, F], …] }                      straight lines through the points, F(0) = 0
///
/// @throws support::InputError also for a damper that would generate energy
/// Checked by tests/dynamics/element_input/force_input_test.cpp
PiecewisePolynomial read_damper(const support::TomlTable& table, const LawUnits& units = kTranslation);

}  // namespace sprung::dynamics

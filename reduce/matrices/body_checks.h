#pragma once

#include <optional>

#include "reduce/matrices/matrix_body.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

/// Mass properties that the user knows of a body, in SI units.
struct ExpectedMass {
  support::SourceLocation where;          ///< for messages
  std::optional<double> mass;             ///< [kg]
  std::optional<Eigen::Vector2d> centre;  ///< of mass, in the plane [m]
  std::optional<double> inertia;          ///< about the centre of mass [kg·m²]
  double tolerance = 1e-3;                ///< of each, relative; of the centre of the radius of inertia
};

/// Checks matrices before anything is computed from them (reduce/matrices, "Checks"): every freedom has
/// stiffness; the body is one; rigid motions cause no force; the mass is positive definite where there is
/// any, and that of a body whose nodes are where the table says.
///
/// @return remarks: freedoms without mass
/// @throws support::InputError naming the freedoms concerned
/// Checked by tests/reduce/matrices/matrix_errors_test.py
std::vector<std::string> check_matrix_body(const MatrixBody& body);

/// Compares mass, centre of mass and moment of inertia.
/// @throws support::InputError at `expected.where`
void check_expected_mass(const MatrixBody& body, const ExpectedMass& expected);

}  // namespace sprung::reduce

#pragma once

#include "fem/axial_force.h"
#include "fem/beam_element.h"

namespace sprung::fem {

/// Slope w' of the shape functions in own axes at ξ = x/L; equal to ψ without shear deformation
/// (fem, eq. 7).
///
/// @param length  > 0 [m]
/// @return 1×6 [1/m, -]
/// Checked by tests/fem/geometric_stiffness_test.cpp
Eigen::Matrix<double, 1, 6> calc_slope(double length, const BeamProperties& properties, double xi);

/// Geometric stiffness in own axes, Kᴳ = ∫ N w'ᵀ w' dx, of an element under an axial force: the forces at its
/// ends that arise because the axial force rotates with the beam (fem, eq. 21).
///
/// @param length  > 0 [m]
/// @return 6×6, symmetric, zero for axial displacements and translation [N/m, N, N·m]
/// @throws std::invalid_argument if length is not positive or properties are out of range
/// Source: [Przemieniecki 1968], §15.2 — checked by tests/fem/geometric_stiffness_test.cpp
Matrix6 calc_local_geometric_stiffness(double length, const BeamProperties& properties,
                                       const AxialForce& axial_force);

/// Slopes S of an element per displacement of its ends in mesh axes, each scaled with the root of the length
/// that it stands for: under an axial force N that is constant along it, Kᴳ = N SᵀS.
/// @return 4×6 [1/√m, √m]
/// Checked by tests/fem/geometric_stiffness_test.cpp
Eigen::Matrix<double, 4, 6> calc_scaled_slopes(const BeamElement& element);

/// Geometric stiffness in mesh axes, Tᵀ Kᴳ T [N/m, N, N·m].
Matrix6 calc_geometric_stiffness(const BeamElement& element, const AxialForce& axial_force);

}  // namespace sprung::fem

#pragma once

#include <Eigen/Core>

#include "fem/beam_properties.h"

namespace sprung::fem {

/// Dof order of a planar beam element: (x displacement, y displacement, rotation) at the first, then the
/// second end. In the element's *own axes* x runs from the first to the second end and y is 90°
/// counter-clockwise from it.
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Shear parameter Φ = 12 EI / (κGA L²) [-], 0 without shear deformation (fem, eq. 5).
double calc_shear_parameter(double length, const BeamProperties& properties);

/// Shape functions in own axes at ξ = x/L: displacements and section rotation (u, w, ψ) = N(ξ) qᵉ.
///
/// Axial linear; bending by the exact homogeneous solution of the Timoshenko beam, which is the Hermite cubic
/// with ψ = w' where Φ = 0 (fem, eqs. 6–8).
///
/// @param length  > 0 [m]
/// @param xi      0 … 1 [-]
/// @return 3×6, rows u, w, ψ [-, m; 1/m, -]
/// @throws std::invalid_argument if length is not positive or properties are out of range
/// Source: [Friedman & Kosmatka 1993] — checked by tests/fem/beam_element_test.cpp
Eigen::Matrix<double, 3, 6> calc_shape_functions(double length, const BeamProperties& properties, double xi);

/// Stiffness in own axes, 6×6, symmetric, three zero modes [N/m, N, N·m] (fem, eq. 9).
///
/// @param length  > 0 [m]
/// @throws std::invalid_argument if length is not positive or properties are out of range
/// Source: [Przemieniecki 1968], §5.6 — checked by tests/fem/beam_element_test.cpp
Matrix6 calc_local_stiffness(double length, const BeamProperties& properties);

/// Consistent mass in own axes, translation and rotary inertia, 6×6, symmetric [kg, kg·m, kg·m²]
/// (fem, eqs. 10–12).
///
/// @param length  > 0 [m]
/// @throws std::invalid_argument if length is not positive or properties are out of range
/// Source: [Friedman & Kosmatka 1993] — checked by tests/fem/beam_element_test.cpp
Matrix6 calc_local_mass(double length, const BeamProperties& properties);

/// A straight planar beam between two points, in the mesh's axes.
struct BeamElement {
  Eigen::Vector2d first;   ///< position of the first end [m]
  Eigen::Vector2d second;  ///< position of the second end [m]
  BeamProperties properties;
};

/// Distance between the ends [m].
double calc_length(const BeamElement& element);

/// Own-axes dofs from mesh-axes dofs, orthogonal 6×6: q_own = T q_mesh (fem, eq. 13).
/// @throws std::invalid_argument if the ends coincide
Matrix6 calc_rotation(const BeamElement& element);

/// Stiffness in mesh axes, Tᵀ Kᵉ T [N/m, N, N·m].
Matrix6 calc_stiffness(const BeamElement& element);

/// Consistent mass in mesh axes, Tᵀ Mᵉ T [kg, kg·m, kg·m²].
Matrix6 calc_mass(const BeamElement& element);

/// Stress resultants at the ends from the displacements of the ends in mesh axes, from the element's
/// stiffness, that is, exact for static loads at the nodes (fem, eqs. 14, 15).
///
/// Signs: N tension positive; M = EI ψ' positive where the fibres on the side of −y (own axes) are stretched;
/// Q = −dM/dx = κGA (w' − ψ).
///
/// @return 6×6, rows N, Q, M at the first, then at the second end [N, N, N·m]
/// Checked by tests/fem/beam_element_test.cpp
Matrix6 calc_resultants(const BeamElement& element);

}  // namespace sprung::fem

#pragma once

#include <Eigen/Core>

#include "fem/beam_element.h"

namespace sprung::fem {

/// ∫ρA (N_yᵀN_x − N_xᵀN_y) ds in mesh axes: times the displacements of the ends, the inertia of the element
/// under the acceleration (−u_y, u_x), which is its displacement turned by +90° (fem, eq. 29).
/// @return 6×6, skew [kg, kg·m, kg·m²]
/// Checked by tests/fem/spread_loads_test.cpp
Matrix6 calc_turned_mass(const BeamElement& element);

/// Stress resultants at the ends of an element that carries a load between them. They are exact at the ends;
/// the displacements alone would give those of the same load at the nodes (fem, eq. 30).
///
/// @param ends  displacements of the ends, mesh axes, 6×k
/// @param load  the element's load as forces and moments on its ends, mesh axes, 6×k [N, N·m]
/// @return 6×k, as calc_resultants
/// Checked by tests/fem/spread_loads_test.cpp
Eigen::MatrixXd calc_loaded_resultants(const BeamElement& element,
                                       const Eigen::Ref<const Eigen::MatrixXd>& ends,
                                       const Eigen::Ref<const Eigen::MatrixXd>& load);

}  // namespace sprung::fem

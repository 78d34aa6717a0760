#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "fem/axial_force.h"
#include "fem/beam_model.h"
#include "fem/element_rates.h"

namespace sprung::fem {

/// Matrices of a free frame of N nodes. Dofs 3n, 3n+1, 3n+2 are node n's x and y displacement and rotation.
struct AssembledMatrices {
  Eigen::SparseMatrix<double> stiffness;  ///< 3N×3N, symmetric, zero on the three rigid motions [N/m, N, N·m]
  Eigen::SparseMatrix<double> mass;       ///< 3N×3N, symmetric, with the point masses [kg, kg·m, kg·m²]
};

/// Adds up the element matrices and the point masses. Both results are exactly symmetric and compressed. Of
/// nodes that follow others nothing is left: no mass, and springs that nothing else touches, so that the size
/// stays.
///
/// @throws std::invalid_argument if the model is not consistent (check_beam_model)
/// Checked by tests/fem/assembly_test.cpp
AssembledMatrices assemble(const BeamModel& model);

/// Rates of change of a frame with some number of a design.
struct BeamModelRates {
  Eigen::Matrix2Xd node_positions;          ///< 2×N
  std::vector<BeamPropertyRates> sections;  ///< one for each section of the model
  /// one for each point mass: of its mass and inertia
  std::vector<Eigen::Vector2d> point_masses;
};

/// Rates of the matrices that `assemble` gives.
/// @throws std::invalid_argument if the model is not consistent
/// Checked by tests/fem/element_rates_test.cpp
AssembledMatrices assemble_rates(const BeamModel& model, const BeamModelRates& rates);

/// Adds up the elements' geometric stiffness under given axial forces (fem, eq. 21).
///
/// @param axial_forces  one for each element
/// @return 3N×3N, exactly symmetric, zero on the two translations [N/m, N, N·m]
/// @throws std::invalid_argument if the model is not consistent, or there are not as many forces as elements
/// Checked by tests/fem/geometric_stiffness_test.cpp
Eigen::SparseMatrix<double> assemble_geometric_stiffness(const BeamModel& model,
                                                         const std::vector<AxialForce>& axial_forces);

}  // namespace sprung::fem

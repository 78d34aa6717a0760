#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace sprung::reduce {

/// Stiffness and mass of a held frame: its assembled matrices without the freedoms of the reference node, in
/// mesh order. Both n×n, symmetric and positive definite.
struct ModalProblem {
  Eigen::SparseMatrix<double> stiffness;  ///< K [N/m, N, N·m]
  Eigen::SparseMatrix<double> mass;       ///< M [kg, kg·m, kg·m²]

  Eigen::Index size() const { return stiffness.rows(); }
};

/// Solutions of K φ = ω² M φ, ascending. k of them.
struct EigenPairs {
  Eigen::VectorXd omega_squared;  ///< k [rad²/s²]
  Eigen::MatrixXd vectors;        ///< n×k, φᵀ M φ = I [1/√kg; rotations 1/(m·√kg)]
};

}  // namespace sprung::reduce

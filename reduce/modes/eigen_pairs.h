#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cmath>
#include <numbers>

#include "reduce/factors/tall_products.h"

namespace sprung::reduce {

class StiffnessFactor;

/// Stiffness and mass of a held frame: its assembled matrices without the freedoms of the reference node, in
/// mesh order. Both n×n, symmetric and positive definite. The elastic motion of a free frame has the same
/// stiffness, and the mass M − Q Qᵀ (reduce/basis, eq. 2). Where matrices of other programs give the body,
/// some freedoms may have no mass; their rows of M are zero, and there are fewer modes by as many.
struct ModalProblem {
  Eigen::SparseMatrix<double> stiffness;  ///< K [N/m, N, N·m]
  Eigen::SparseMatrix<double> mass;       ///< M [kg, kg·m, kg·m²]
  Eigen::MatrixXd rigid_share = {};       ///< Q, n×3 of a free frame, empty of a held one [√kg, √kg·m]
  const StiffnessFactor* factor = nullptr;  ///< of K, where it was made already
  /// Zero rows of M; of a free frame those of the reference node too, which take as much from the rank of M −
  /// Q Qᵀ
  Eigen::Index num_massless = 0;

  Eigen::Index size() const { return stiffness.rows(); }
  Eigen::Index num_modes() const { return size() - num_massless; }
  bool is_free() const { return rigid_share.size() > 0; }

  /// (M − Q Qᵀ) x.  @param x  n×k
  Eigen::MatrixXd times_mass(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd y = multiply_transposed(mass, x);
    if (is_free()) add_combinations(rigid_share, -multiply_transposed(rigid_share, x), y);
    return y;
  }
};

/// Solutions of K φ = ω² M φ, ascending. k of them.
struct EigenPairs {
  Eigen::VectorXd omega_squared;  ///< k [rad²/s²]
  Eigen::MatrixXd vectors;        ///< n×k, φᵀ M φ = I [1/√kg; rotations 1/(m·√kg)]
};

/// f = ω/2π [Hz].
inline double calc_frequency_hz(double omega_squared) {
  return std::sqrt(omega_squared) / (2.0 * std::numbers::pi);
}

}  // namespace sprung::reduce

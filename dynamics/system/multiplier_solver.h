#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/system/block_jacobian.h"

namespace sprung::dynamics {

/// Solves (φ_q M⁻¹ φ_qᵀ) λ = r. The matrix couples only constraints that share a body: dense Cholesky where it is small,
/// sparse Cholesky with one analysis of its pattern where it is large (that one allocates in each factorisation).
class MultiplierSolver {
 public:
  explicit MultiplierSolver(const BlockJacobian& jacobian, int num_constraints);

  /// @return false where the matrix is not positive definite: constraints have become dependent
  bool factorise(const BlockJacobian& jacobian, const std::vector<BodyMass>& masses);
  /// λ ← the solution. @param r num_constraints
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const;

 private:
  // Blocks p and q of the Jacobian on one body: their product goes to rows of p, columns of q.
  struct Pair {
    std::size_t p, q;
    std::vector<std::size_t> column_targets;  // of each row of q: where the first row of p goes
  };

  int num_constraints_;
  bool is_dense_;
  std::vector<Pair> pairs_;
  std::vector<std::size_t> row_offsets_;  // of each block's rows in Y_ and, times modes, in Z_
  std::vector<std::size_t> modal_offsets_;
  std::vector<double> Y_, CY_, Z_;
  Eigen::MatrixXd dense_;
  Eigen::LLT<Eigen::MatrixXd> dense_factor_;
  Eigen::SparseMatrix<double> sparse_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> sparse_factor_;
};

}  // namespace sprung::dynamics

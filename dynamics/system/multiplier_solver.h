#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/system/block_jacobian.h"
#include "dynamics/system/sparse_cholesky.h"

namespace sprung::dynamics {

/// Solves (φ_q M⁻¹ φ_qᵀ) λ = r. The matrix couples only constraints that share a body: the cost grows with the number
/// of such pairs and of what elimination adds to them. No allocation once made.
class MultiplierSolver {
 public:
  MultiplierSolver(const BlockJacobian& jacobian, int num_constraints);

  /// @return false where the matrix is not positive definite: constraints have become dependent
  bool factorise(const BlockJacobian& jacobian, const std::vector<BodyMass>& masses);
  /// λ ← the solution. @param r num_constraints
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const;
  int num_factor_entries() const { return factor_.num_factor_entries(); }

 private:
  // Blocks p and q of the Jacobian on one body: rows of p times rows of q. Where both are a joint's own rows, only
  // those of q up to the row of p.
  struct Pair {
    std::size_t p, q;
    std::size_t first_place;  // of the products in the matrix, q's rows running faster
    bool same_rows;
  };
  template <int num_modes>
  void add_products(const Pair& pair, const BlockJacobian& jacobian);

  std::vector<Pair> pairs_;
  std::vector<int> places_;
  std::vector<std::size_t> row_offsets_;  // of each block's rows in Y_, and of its modal parts in Z_
  std::vector<std::size_t> modal_offsets_;
  std::vector<Eigen::Vector3d> Y_, CY_;  // of each row: reduced, and times C⁻¹
  std::vector<double> Z_;
  SparseCholesky factor_;
};

}  // namespace sprung::dynamics

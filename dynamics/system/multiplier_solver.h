#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/system/block_jacobian.h"
#include "dynamics/system/sparse_cholesky.h"

namespace sprung::dynamics {

/// Solves (φ_q M⁻¹ φ_qᵀ) λ = r. The matrix couples only constraints that share a body: the cost grows with
/// the number of such pairs and of what elimination adds to them. No allocation once made.
class MultiplierSolver {
 public:
  MultiplierSolver(const BlockJacobian& jacobian, int num_constraints);

  /// @return false where the matrix is not positive definite: constraints have become dependent
  bool factorise(const BlockJacobian& jacobian, const std::vector<BodyMass>& masses);
  /// λ ← the solution. @param r num_constraints
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const;
  int num_factor_entries() const { return factor_.num_factor_entries(); }

 private:
  // Blocks p and q of the Jacobian on one body: rows of p times rows of q.
  struct Pair {
    int num_rows_p, num_rows_q, num_modes;
    std::size_t row_p, row_q;      // in Y_ and CY_
    std::size_t modal_p, modal_q;  // in the Jacobian's values and in Z_
    std::size_t first_place;       // of the products in places_, q's rows running faster
  };
  template <int num_rows, int num_modes>
  void add_products(const Pair& pair, const double* jacobian_values);

  std::vector<Pair> pairs_;
  std::vector<int> places_;               // in the matrix; of what stands above the diagonal: beside it
  std::vector<std::size_t> row_offsets_;  // of each block's rows in Y_, and of its modal parts in Z_
  std::vector<std::size_t> modal_offsets_;
  std::vector<Eigen::Vector3d> Y_, CY_;  // of each row: reduced, and times C⁻¹
  std::vector<double> Z_;
  SparseCholesky factor_;
};

}  // namespace sprung::dynamics

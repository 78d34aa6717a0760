#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/system/block_cholesky.h"
#include "dynamics/system/block_jacobian.h"

namespace sprung::dynamics {

/// Solves (φ_q M⁻¹ φ_qᵀ) λ = r. The matrix couples only constraints that share a body: the cost grows with
/// the number of such pairs and of what elimination adds to them. No allocation once made.
///
/// Constraints are taken two at a time, as nodes; of a joint with an odd number the last one has beside it a
/// row that is coupled with nothing.
class MultiplierSolver {
 public:
  MultiplierSolver(const BlockJacobian& jacobian, int num_constraints);

  /// @return false where the matrix is not positive definite: constraints have become dependent
  bool factorise(const BlockJacobian& jacobian, const std::vector<BodyMass>& masses);
  /// λ ← the solution. @param r num_constraints
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const;
  int num_factor_entries() const { return factor_.num_factor_entries(); }

 private:
  // A row of the Jacobian on one body, made ready for products (BodyMass::reduce_row).
  struct Row {
    std::size_t source;  // in the Jacobian's values
    std::size_t value;   // in U_ and V_, where the two rows of a node alternate
  };
  // Rows and products of nodes on one body.
  struct BodyPart {
    std::size_t body;
    int num_columns;  // 3 + modes
    std::size_t first_row, last_row = 0;
    std::size_t first_product = 0, last_product = 0;
  };
  struct Product {
    std::size_t u, v;  // in U_ and V_
    int place;         // of the block U Vᵀ in the matrix
  };
  struct Member;
  void list_products(const std::vector<Member>& members, BodyPart& part);
  template <int num_columns>
  void add_products(const BodyPart& part);

  std::vector<BodyPart> parts_;
  std::vector<Row> rows_;
  std::vector<Product> products_;
  std::vector<double> U_, V_;
  std::vector<int> lone_;            // diagonal blocks of nodes with one constraint
  std::vector<std::size_t> places_;  // of each constraint in work_
  BlockCholesky factor_;
  mutable std::vector<double> work_;
};

}  // namespace sprung::dynamics

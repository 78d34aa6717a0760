#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/linear_algebra/block_cholesky.h"
#include "dynamics/system/block_jacobian.h"

namespace sprung::dynamics {

/// Solves (φ_q M⁻¹ φ_qᵀ) λ = r. The matrix couples only constraints that share a body: the cost grows with
/// the number of such pairs and with the fill-in of the elimination. Allocates nothing once made.
///
/// Two constraints of a joint at a time form a node. If their number is odd, the last node has a second row
/// that is coupled with nothing.
class MultiplierSolver {
 public:
  MultiplierSolver(const BlockJacobian& jacobian, int num_constraints);

  /// @return false where the matrix is not positive definite: constraints have become dependent
  bool factorise(const BlockJacobian& jacobian, const std::vector<BodyMass>& masses);
  /// λ ← the solution. @param r num_constraints
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const;
  int num_factor_entries() const { return factor_.num_factor_entries(); }

 private:
  // The one or two rows of the Jacobian of a node on a body, prepared for products (BodyMass::reduce_rows).
  struct Member {
    int node;
    int num_rows;
    std::size_t source;  // of the first row, in the Jacobian's values
    std::size_t value;   // in U_ and V_: a column for each of the body's coordinates
  };
  // Members and products of nodes on one body.
  struct BodyPart {
    std::size_t body;
    int num_columns;  // 3 + modes
    std::size_t first_member, last_member = 0;
    std::size_t first_product = 0, last_product = 0;
  };
  struct Product {
    std::size_t u, v;  // in U_ and V_
    int place;         // of the block U Vᵀ in the matrix
  };
  void list_products(BodyPart& part);
  void add_products(const BodyPart& part);

  std::vector<BodyPart> parts_;
  std::vector<Member> members_;
  std::vector<Product> products_;
  std::vector<Eigen::Vector2d> U_, V_;
  std::vector<double> no_row_;                    // zeros, the second row of a node that has one
  std::vector<int> lone_;                         // diagonal blocks of nodes with one constraint
  std::vector<std::pair<int, int>> constraints_;  // of each node in work_; −1: no second one
  BlockCholesky factor_;
  mutable std::vector<Eigen::Vector2d> work_;
};

}  // namespace sprung::dynamics

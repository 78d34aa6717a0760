#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <vector>

#include "dynamics/system/index3_residual.h"

namespace sprung::dynamics {

/// Newton's equations of an implicit step on the index-3 system. δ is the change of the accelerations at the
/// end of the step, by which v̇ changes b₀δ, v changes b₁δ and q changes b₂δ:
///
///     | b₀M + b₁C + b₂K   φ_qᵀ | | δ  |     | r    |
///     | φ_q               0    | | δλ | = − | φ/b₂ |                                  (system, eq. 10)
///
/// The unknowns are accelerations and multipliers and the second row is divided by b₂, so that the matrix
/// tends to a limit as the step becomes short; coordinates are scaled by 1/√M_jj and constraints to rows of
/// length one, so that it does not depend on units either. Dense up to a hundred unknowns or so, sparse
/// beyond (that one allocates). Source: [Bottasso, Dopico & Trainelli 2008]
class Index3Newton {
 public:
  /// b₀ [1], b₁ [s], b₂ [s²]
  struct Weights {
    double acceleration = 1.0, velocity = 0.0, position = 0.0;
  };

  explicit Index3Newton(const Model& model);

  /// K = ∂r/∂q and C = ∂r/∂v by forward differences. Bodies without a common neighbour are moved at once, so
  /// that the number of differences does not grow with the length of a chain. Afterwards `residual` is that
  /// of `motion` again.
  void linearise(Index3Residual& residual, const ConstrainedMotion& motion, std::span<const int> branches);
  /// Factors with M and φ_q of the terms and the K and C at hand.
  /// @return false where the matrix is singular
  bool factorise(const SystemTerms& terms, const Weights& weights);
  /// @param r     nq, residual of the forces   @param phi  m, φ/b₂
  /// @param[out] delta  nq                        @param[out] delta_lambda  m
  void solve(const Eigen::VectorXd& r, const Eigen::VectorXd& phi, Eigen::VectorXd& delta,
             Eigen::VectorXd& delta_lambda);

  /// (b₁C + b₂K) y, with the C, K and weights of the matrix that was factorised: by how much the forces
  /// differ where velocities differ by b₁y and positions by b₂y. @param y  nq   @param[out] force  nq
  void calc_force_change(const Eigen::VectorXd& y, Eigen::VectorXd& force) const;

  /// The scaled matrix that was factorised: for tests.
  Eigen::MatrixXd dense() const;

 private:
  // Coordinates that are moved together: those of a body, followed by the groups of the states of a force
  // element.
  struct Group {
    int first, size;
  };
  // Derivatives of the forces on one group by the coordinates of another on which they depend, or by its own.
  struct Coupling {
    int row_group, column_group;
    Eigen::MatrixXd K, C;
  };
  struct Entry {
    int row, column;
    double value;
  };

  void find_couplings();
  void colour_groups();
  void difference(Index3Residual& residual, ConstrainedMotion& moved, std::span<const int> branches,
                  bool of_velocity);
  void collect_entries(const SystemTerms& terms, const Weights& weights);

  const Model* model_;
  int num_coordinates_, num_constraints_;
  std::vector<Group> groups_;
  std::vector<Coupling> couplings_;
  std::vector<std::vector<int>> colours_;  // groups that are moved at once
  Eigen::VectorXd base_force_;
  ConstrainedMotion moved_;

  Weights weights_;
  std::vector<Entry> entries_;  // of the scaled matrix
  Eigen::VectorXd coordinate_scale_, constraint_scale_, unknowns_, solution_;
  bool is_dense_;
  Eigen::MatrixXd dense_;
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_factor_;
  Eigen::SparseMatrix<double> sparse_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse_factor_;
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/linear_algebra/block_triangular_form.h"
#include "dynamics/linear_algebra/sparse_lu.h"
#include "dynamics/system/block_jacobian.h"
#include "dynamics/system/partition.h"

namespace sprung::dynamics {

/// Solves φ_d x = r, φ_d being the columns of φ_q that belong to the dependent coordinates.
///
/// The pattern of φ_d is permuted to block triangular form once for a partition: independent loops and links
/// of a chain become blocks of their own, solved one after the other. So the cost grows with the number of
/// joints and not with its cube (BlockTriangularForm).
class DependentSolver {
 public:
  DependentSolver() = default;
  DependentSolver(const BlockJacobian& jacobian, const Partition& partition, int num_coordinates);

  /// Factors of φ_d at the present values of the Jacobian. Allocates memory only where pivots are chosen, see
  /// SparseLu.
  void factorise(const BlockJacobian& jacobian);
  /// r += φ_i x_i, at the present values of the Jacobian that was factorised last.
  /// @param x_independent  in the order of Partition::independent   @param r  num_constraints
  void add_independent_product(std::span<const double> x_independent, Eigen::VectorXd& r) const;
  /// r = column k of φ_i, of the same Jacobian.
  /// @param k  position in Partition::independent   @param r  num_constraints
  void get_independent_column(std::size_t k, Eigen::VectorXd& r) const;
  /// x = φ_d⁻¹ r; NaN where φ_d has no inverse whatever its values.
  /// @param r, x  num_constraints; x in the order of Partition::dependent
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& x) const;
  /// y = φ_d⁻ᵀ r; NaN where φ_d has no inverse whatever its values.
  /// @param r  in the order of Partition::dependent, overwritten   @param y  num_constraints
  void solve_transposed(Eigen::VectorXd& r, Eigen::VectorXd& y) const;
  /// x_i −= φ_iᵀ y. @param y  num_constraints   @param x_independent  in the order of Partition::independent
  void subtract_transposed_product(const Eigen::VectorXd& y, std::span<double> x_independent) const;
  /// 1 where a dependent coordinate may move with an independent one at some position, 0 where it never does.
  /// @param num_independent  f   @return num_constraints×f, in the orders of Partition
  Eigen::MatrixXd find_followers(int num_independent) const;
  /// Marks the present factors as those of a good partition.
  void set_reference();
  /// Moves the reference to the present factors in the blocks whose determinant is larger than it was there.
  void raise_reference();
  /// Largest factor by which the determinant of a block has fallen since the reference.
  double decay() const;
  /// Whether the determinant of a block has changed sign since `set_reference`. It cannot do so along a
  /// motion: a mechanism passes det φ_d = 0 only at a turning point of its independent coordinates, before
  /// which another partition is chosen, and at a change point, which is passed in a step of its own.
  bool is_mirrored() const;
  int num_factor_entries() const;

 private:
  struct Entry {
    int row;             // of the block
    int column;          // dependent coordinate (position in the partition)
    std::size_t source;  // in the Jacobian's values
  };
  // A block of one row and one column, as most are in chains. They are stored side by side.
  struct Single {
    int row, column;  // constraint; position in Partition::dependent
    std::size_t end_of_outside =
        0;                   // of its entries in outside_of_singles_, which begin where those before end
    std::size_t source = 0;  // of its value
    double inverse = 0.0;    // of the value
    double reference = 0.0;  // the value at the reference
  };
  struct Coupling {
    int column;
    std::size_t source;
  };
  struct DiagonalBlock {
    std::size_t num_singles_before;   // that are solved first
    std::vector<int> rows, columns;   // constraints; positions in Partition::dependent
    std::vector<std::size_t> inside;  // sources of the block's own entries
    std::vector<Entry> outside;       // in its rows, in columns of the blocks before
    SparseLu lu{0, {}};
    double reference_determinant = 0.0;
  };
  bool add_single(const std::vector<PatternEntry>& entries, const BlockTriangularForm& form);
  const DiagonalBlock& add_block(const std::vector<int>& group, const PatternRows& rows,
                                 const BlockTriangularForm& form);
  void solve_singles(std::size_t first, std::size_t end, const Eigen::VectorXd& r, Eigen::VectorXd& x) const;
  void solve_singles_transposed(std::size_t first, std::size_t end, Eigen::VectorXd& r,
                                Eigen::VectorXd& y) const;

  // Columns of a block of the Jacobian that lie side by side and belong to independent coordinates.
  struct Strip {
    std::size_t offset;      // of its first value
    int row, num_rows;       // constraints
    int stride;              // from row to row
    int first, num_columns;  // positions in Partition::independent
  };
  void collect_strips(const BlockJacobian& jacobian, const Partition& partition, int num_coordinates);

  std::vector<Strip> strips_;
  std::vector<Single> singles_;
  std::vector<Coupling> outside_of_singles_;
  std::vector<DiagonalBlock> blocks_;
  bool is_regular_ = true;            // its pattern
  const double* values_ = nullptr;    // of the Jacobian that was factorised
  std::vector<double> entries_;       // of one block
  mutable std::vector<double> work_;  // of the largest block
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <span>

namespace sprung::reduce {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Factors A = Pᵀ L D Lᵀ P of a sparse symmetric matrix.
class SparseFactor {
 public:
  virtual ~SparseFactor() = default;

  /// A⁻¹ x.  @param x  n×k, best of all columns at once   @return n×k
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const = 0;
  /// Number of negative entries of D.
  virtual int num_negative() const = 0;
  /// P: the unknowns in the order of elimination, n.
  virtual std::span<const int> order() const = 0;
};

enum class FactorMethod {
  kAutomatic,   ///< CHOLMOD for more than kMostSimplicial unknowns, where it is there
  kSimplicial,  ///< Eigen's LDLᵀ
  kCholmod      ///< CHOLMOD: supernodal of a positive definite matrix, with the order of METIS
};
inline constexpr Eigen::Index kMostSimplicial = 5'000;

/// Whether the program was built with CHOLMOD. Without it everything works, and large frames take longer.
bool has_cholmod();

/// @param matrix       n×n, symmetric
/// @param is_definite  whether it has to be positive definite
/// @param order        an order of elimination, as of a matrix with the same pattern; empty: a new one
/// @return null where a pivot vanishes, or is not positive and has to be
/// @throws std::invalid_argument if kCholmod is asked for and was not built
/// Checked by tests/reduce/modes/sparse_factor_test.cpp
std::unique_ptr<SparseFactor> make_sparse_factor(const SparseMatrix& matrix, bool is_definite,
                                                 std::span<const int> order = {},
                                                 FactorMethod method = FactorMethod::kAutomatic);

}  // namespace sprung::reduce

#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

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
  /// Factors of another matrix, with entries at most where this one's are, in the same order; it need not be
  /// definite. @return null where a pivot vanishes
  virtual std::unique_ptr<SparseFactor> factor_like(const SparseMatrix& matrix) const = 0;
};

enum class FactorMethod {
  kAutomatic,   ///< supernodal for more than kMostSimplicial unknowns, where CHOLMOD is there
  kSimplicial,  ///< Eigen's
  kSupernodal   ///< ours, with CHOLMOD's analysis in the order of METIS
};
inline constexpr Eigen::Index kMostSimplicial = 5'000;

/// Whether the program was built with CHOLMOD. Without it everything works, and large frames take longer.
bool has_cholmod();

/// @param matrix       n×n, symmetric
/// @param is_definite  whether it has to be positive definite
/// @return null where a pivot vanishes, or is not positive and has to be
/// @throws std::invalid_argument if kSupernodal is asked for and CHOLMOD was not built in
/// Checked by tests/reduce/factors/sparse_factor_test.cpp
std::unique_ptr<SparseFactor> make_sparse_factor(const SparseMatrix& matrix, bool is_definite,
                                                 FactorMethod method = FactorMethod::kAutomatic);

}  // namespace sprung::reduce

#pragma once

#include <Eigen/Core>
#include <optional>

namespace sprung::support {

/// Eigenvalues in ascending order, with the eigenvectors as columns.
struct SymmetricEigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// A x = λ x with xᵀx = 1. @param A  n×n symmetric; its lower triangle is read
/// @return none where the iteration does not converge
std::optional<SymmetricEigenpairs> solve_symmetric(const Eigen::MatrixXd& A);
/// The eigenvalues alone, ascending. @param A  n×n symmetric; its lower triangle is read
Eigen::VectorXd calc_symmetric_eigenvalues(const Eigen::MatrixXd& A);

/// Undamped vibration: K x = ω² M x with xᵀMx = 1, of the symmetric part of K. values are ω².
/// @param K  n×n   @param M  n×n, symmetric positive definite
/// @return none where M is not positive definite or the iteration does not converge
std::optional<SymmetricEigenpairs> solve_undamped(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);

/// Eigenpairs of a real matrix that need not be symmetric; complex ones stand side by side, Im > 0 first.
struct GeneralEigenpairs {
  Eigen::VectorXcd values;
  /// n×n: the vector of a real value; of a pair its real and its imaginary part, side by side: A [x y] = [x
  /// y] [a b; −b a].
  Eigen::MatrixXd real_vectors;

  Eigen::VectorXcd vector(Eigen::Index k) const;  ///< of values[k], of length 1
};
/// @return none where the iteration does not converge
std::optional<GeneralEigenpairs> solve_general(const Eigen::MatrixXd& A);

/// A = U T Uᴴ, T upper triangular.
struct ComplexSchurForm {
  Eigen::MatrixXcd U, T;
};
/// @return none where the iteration does not converge
std::optional<ComplexSchurForm> make_schur_form(const Eigen::MatrixXd& A);

}  // namespace sprung::support

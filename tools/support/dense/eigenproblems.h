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
/// @return none if the iteration does not converge
std::optional<SymmetricEigenpairs> solve_symmetric(const Eigen::MatrixXd& A);
/// The same of a complex matrix, xᴴx = 1.
struct HermitianEigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXcd vectors;
};
/// @param A  n×n Hermitian; its lower triangle is read   @return none if the iteration does not converge
std::optional<HermitianEigenpairs> solve_hermitian(const Eigen::MatrixXcd& A);
/// The eigenvalues alone, ascending. @param A  n×n symmetric; its lower triangle is read
Eigen::VectorXd calc_symmetric_eigenvalues(const Eigen::MatrixXd& A);

/// Undamped vibration: K x = ω² M x with xᵀMx = 1; the values are ω². Only the symmetric part of K counts.
/// @param K  n×n   @param M  n×n, symmetric positive definite
/// @return none if M is not positive definite or the iteration does not converge
std::optional<SymmetricEigenpairs> solve_undamped(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);

/// Eigenpairs of a real matrix that need not be symmetric. Complex values come in pairs, the one with Im > 0
/// first.
struct GeneralEigenpairs {
  Eigen::VectorXcd values;
  /// n×n. The column of a real value is its vector. The two columns of a pair a ± ib are the real and the
  /// imaginary part of its first vector: A [x y] = [x y] [a b; −b a].
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

#include "tools/support/dense/eigenproblems.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <complex>

namespace sprung::support {

std::optional<SymmetricEigenpairs> solve_symmetric(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return SymmetricEigenpairs{};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return SymmetricEigenpairs{solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd calc_symmetric_eigenvalues(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {};
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

std::optional<SymmetricEigenpairs> solve_undamped(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  if (M.size() == 0) return SymmetricEigenpairs{};
  if (Eigen::LLT<Eigen::MatrixXd>(M).info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd symmetric = 0.5 * (K + K.transpose());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric, M);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return SymmetricEigenpairs{solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd GeneralEigenpairs::vector(Eigen::Index k) const {
  Eigen::VectorXcd x(real_vectors.rows());
  if (values[k].imag() == 0.0) {
    x = real_vectors.col(k).cast<std::complex<double>>();
  } else {
    const Eigen::Index first = values[k].imag() > 0.0 ? k : k - 1;
    x.real() = real_vectors.col(first);
    x.imag() =
        values[k].imag() > 0.0 ? real_vectors.col(first + 1) : Eigen::VectorXd(-real_vectors.col(first + 1));
  }
  return x.normalized();
}

std::optional<GeneralEigenpairs> solve_general(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return GeneralEigenpairs{solver.eigenvalues(), solver.pseudoEigenvectors()};
}

std::optional<ComplexSchurForm> make_schur_form(const Eigen::MatrixXd& A) {
  const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(A.cast<std::complex<double>>());
  if (schur.info() != Eigen::Success) return std::nullopt;
  return ComplexSchurForm{schur.matrixU(), schur.matrixT()};
}

}  // namespace sprung::support

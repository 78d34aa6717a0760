#include "tools/support/dense/eigenproblems.h"

#include <complex>

#include "tools/support/dense/lapack.h"

namespace sprung::support {

std::optional<SymmetricEigenpairs> solve_symmetric(const Eigen::MatrixXd& A) {
  SymmetricEigenpairs pairs{.values = Eigen::VectorXd(A.rows()), .vectors = A};
  if (LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', lapack::rows(A), pairs.vectors.data(), lapack::stride(A),
                     pairs.values.data()) != 0)
    return std::nullopt;
  return pairs;
}

std::optional<HermitianEigenpairs> solve_hermitian(const Eigen::MatrixXcd& A) {
  HermitianEigenpairs pairs{.values = Eigen::VectorXd(A.rows()), .vectors = A};
  if (LAPACKE_zheevd(LAPACK_COL_MAJOR, 'V', 'L', lapack::rows(A), pairs.vectors.data(), lapack::stride(A),
                     pairs.values.data()) != 0)
    return std::nullopt;
  return pairs;
}

Eigen::VectorXd calc_symmetric_eigenvalues(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd overwritten = A;
  Eigen::VectorXd values(A.rows());
  if (LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'N', 'L', lapack::rows(A), overwritten.data(), lapack::stride(A),
                     values.data()) != 0)
    values.setConstant(lapack::kNone);
  return values;
}

std::optional<SymmetricEigenpairs> solve_undamped(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  constexpr int kFormKxEqualsLambdaMx = 1;
  SymmetricEigenpairs pairs{.values = Eigen::VectorXd(K.rows()), .vectors = 0.5 * (K + K.transpose())};
  Eigen::MatrixXd factor = M;
  if (LAPACKE_dsygvd(LAPACK_COL_MAJOR, kFormKxEqualsLambdaMx, 'V', 'L', lapack::rows(K), pairs.vectors.data(),
                     lapack::stride(K), factor.data(), lapack::stride(M), pairs.values.data()) != 0)
    return std::nullopt;
  return pairs;
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
  Eigen::MatrixXd overwritten = A;
  Eigen::VectorXd real(A.rows()), imaginary(A.rows());
  GeneralEigenpairs pairs{.values = Eigen::VectorXcd(A.rows()),
                          .real_vectors = Eigen::MatrixXd(A.rows(), A.cols())};
  double* const no_left_vectors = nullptr;
  if (LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', lapack::rows(A), overwritten.data(), lapack::stride(A),
                    real.data(), imaginary.data(), no_left_vectors, 1, pairs.real_vectors.data(),
                    lapack::stride(A)) != 0)
    return std::nullopt;
  pairs.values.real() = real;
  pairs.values.imag() = imaginary;
  return pairs;
}

std::optional<ComplexSchurForm> make_schur_form(const Eigen::MatrixXd& A) {
  ComplexSchurForm form{.U = Eigen::MatrixXcd(A.rows(), A.cols()), .T = A.cast<std::complex<double>>()};
  Eigen::VectorXcd values(A.rows());
  int num_selected = 0;
  if (LAPACKE_zgees(LAPACK_COL_MAJOR, 'V', 'N', nullptr, lapack::rows(A), form.T.data(), lapack::stride(A),
                    &num_selected, values.data(), form.U.data(), lapack::stride(A)) != 0)
    return std::nullopt;
  return form;
}

}  // namespace sprung::support

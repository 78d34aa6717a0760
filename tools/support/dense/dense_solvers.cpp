#include "tools/support/dense/dense_solvers.h"

#include "tools/support/dense/lapack.h"

namespace sprung::support {

namespace {

int solve_in_place(Eigen::MatrixXd& A, std::vector<int>& pivots, Eigen::MatrixXd& x) {
  return LAPACKE_dgesv(LAPACK_COL_MAJOR, lapack::rows(A), lapack::cols(x), A.data(), lapack::stride(A),
                       pivots.data(), x.data(), lapack::stride(x));
}
int solve_in_place(Eigen::MatrixXcd& A, std::vector<int>& pivots, Eigen::MatrixXcd& x) {
  return LAPACKE_zgesv(LAPACK_COL_MAJOR, lapack::rows(A), lapack::cols(x), A.data(), lapack::stride(A),
                       pivots.data(), x.data(), lapack::stride(x));
}

template <class Matrix>
Matrix solve_general_system(Matrix A, Matrix x) {
  std::vector<int> pivots(static_cast<std::size_t>(A.rows()));
  if (solve_in_place(A, pivots, x) != 0) x.setConstant(lapack::kNone);
  return x;
}

}  // namespace

Eigen::MatrixXd solve_lu(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return solve_general_system(A, b);
}

Eigen::MatrixXcd solve_lu(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& b) {
  return solve_general_system(A, b);
}

LuFactors factorise_lu(const Eigen::MatrixXd& A) {
  LuFactors factors{.lu = A, .pivots = std::vector<int>(static_cast<std::size_t>(A.rows()))};
  const double norm = A.size() > 0 ? A.cwiseAbs().colwise().sum().maxCoeff() : 0.0;
  const int n = lapack::rows(A), stride = lapack::stride(A);
  if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, factors.lu.data(), stride, factors.pivots.data()) != 0 ||
      LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', n, factors.lu.data(), stride, norm,
                     &factors.reciprocal_condition) != 0)
    factors.reciprocal_condition = 0.0;
  return factors;
}

Eigen::MatrixXd LuFactors::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  if (LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', lapack::rows(lu), lapack::cols(x), lu.data(), lapack::stride(lu),
                     pivots.data(), x.data(), lapack::stride(x)) != 0)
    x.setConstant(lapack::kNone);
  return x;
}

Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd factor = A, x = b;
  if (!solve_positive_definite_in_place(factor, x)) x.setConstant(lapack::kNone);
  return x;
}

bool solve_positive_definite_in_place(Eigen::MatrixXd& A, Eigen::MatrixXd& x) {
  return LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', lapack::rows(A), lapack::cols(x), A.data(), lapack::stride(A),
                       x.data(), lapack::stride(x)) == 0;
}

bool is_positive_definite(const Eigen::MatrixXd& A) {
  Eigen::MatrixXd factor = A;
  return LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', lapack::rows(A), factor.data(), lapack::stride(A)) == 0;
}

}  // namespace sprung::support

#include "tools/support/dense/dense_solvers.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace sprung::support {

Eigen::MatrixXd solve_lu(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return Eigen::PartialPivLU<Eigen::MatrixXd>(A).solve(b);
}

Eigen::MatrixXcd solve_lu(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& b) {
  return Eigen::PartialPivLU<Eigen::MatrixXcd>(A).solve(b);
}

LuFactors factorise_lu(const Eigen::MatrixXd& A) {
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(A);
  return {.lu = factors.matrixLU(),
          .permutation = factors.permutationP().indices(),
          .reciprocal_condition = factors.rcond()};
}

Eigen::MatrixXd LuFactors::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x(b.rows(), b.cols());
  for (Eigen::Index i = 0; i < b.rows(); ++i) x.row(permutation[i]) = b.row(i);
  lu.triangularView<Eigen::UnitLower>().solveInPlace(x);
  lu.triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  if (A.size() == 0) return b;
  return Eigen::LLT<Eigen::MatrixXd>(A).solve(b);
}

bool is_positive_definite(const Eigen::MatrixXd& A) {
  return A.size() == 0 || Eigen::LLT<Eigen::MatrixXd>(A).info() == Eigen::Success;
}

}  // namespace sprung::support

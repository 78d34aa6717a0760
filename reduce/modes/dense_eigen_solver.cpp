#include "reduce/modes/dense_eigen_solver.h"

#include <Eigen/Cholesky>

#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

Eigen::LLT<Eigen::MatrixXd> factor(const Eigen::MatrixXd& matrix, const char* name) {
  Eigen::LLT<Eigen::MatrixXd> factors(matrix);
  if (factors.info() != Eigen::Success) {
    throw support::NumericalError(
        std::string("modes: the ") + name +
        " matrix is not positive definite to rounding; refine the mesh less, or look for "
        "sections that differ by many orders of magnitude");
  }
  return factors;
}

}  // namespace

EigenPairs solve_dense(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  const Eigen::LLT<Eigen::MatrixXd> L = factor(stiffness, "stiffness");
  const Eigen::LLT<Eigen::MatrixXd> G = factor(mass, "mass");
  const Eigen::MatrixXd lower = G.matrixL();
  const Eigen::MatrixXd W = L.matrixL().solve(lower);
  // Singular values descend, so that frequencies ascend.
  const support::SingularPairs singular = support::calc_right_singular_pairs(W);
  const Eigen::VectorXd& sigma = singular.values;
  if (!sigma.allFinite() || !(sigma.minCoeff() > 0.0)) {
    throw support::NumericalError(
        "modes: a frequency is not finite; the stiffness matrix is singular to rounding");
  }
  EigenPairs pairs;
  pairs.omega_squared = sigma.cwiseAbs2().cwiseInverse();
  pairs.vectors = G.matrixU().solve(singular.vectors);
  return pairs;
}

}  // namespace sprung::reduce

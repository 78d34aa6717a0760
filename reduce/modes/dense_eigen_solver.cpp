#include "reduce/modes/dense_eigen_solver.h"

#include <Eigen/Cholesky>

#include "tools/support/dense/eigenproblems.h"
#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kSmallestMass = 1e-12;  // of a mass matrix scaled to unit diagonal

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

// With a mass of rank r, M = G Gᵀ of n×r. With W v = σ u the solution is φ = K⁻¹ G v / σ².
EigenPairs solve_semidefinite(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass,
                              Eigen::Index rank) {
  Eigen::VectorXd scale = mass.diagonal().cwiseSqrt();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  const auto pairs =
      support::solve_symmetric(scale.cwiseInverse().asDiagonal() * mass * scale.cwiseInverse().asDiagonal());
  if (!pairs || !(pairs->values(pairs->values.size() - rank) > kSmallestMass)) {
    throw support::NumericalError("modes: more freedoms have no mass than the mass matrix has zero rows");
  }
  const Eigen::MatrixXd G =
      scale.asDiagonal() * pairs->vectors.rightCols(rank) * pairs->values.tail(rank).cwiseSqrt().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> L = factor(stiffness, "stiffness");
  const support::SingularPairs singular = support::calc_right_singular_pairs(L.matrixL().solve(G));
  EigenPairs result;
  result.omega_squared = singular.values.cwiseAbs2().cwiseInverse();
  result.vectors = L.solve(G * singular.vectors) * result.omega_squared.asDiagonal();
  return result;
}

}  // namespace

EigenPairs solve_dense(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass,
                       Eigen::Index num_massless) {
  if (num_massless > 0) return solve_semidefinite(stiffness, mass, mass.rows() - num_massless);
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

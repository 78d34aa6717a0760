#include "reduce/modes/dense_eigen_solver.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <string_view>

#include "reduce/modes/stiffness_factor.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr std::string_view kStiffness = "stiffness";
constexpr double kSmallestMass = 1e-12;  // of a mass matrix scaled to unit diagonal

Eigen::LLT<Eigen::MatrixXd> factor(const Eigen::MatrixXd& matrix, std::string_view name) {
  Eigen::LLT<Eigen::MatrixXd> factors(matrix);
  if (factors.info() != Eigen::Success) {
    if (name == kStiffness) {
      throw IndefiniteStiffness(
          "modes: the stiffness matrix is not positive definite to rounding; refine the mesh less, or look "
          "for "
          "sections that differ by many orders of magnitude");
    }
    throw support::NumericalError(
        "modes: the mass matrix is not positive definite to rounding; masses or moments of inertia that "
        "differ by "
        "many orders of magnitude are the usual cause");
  }
  return factors;
}

// With a mass of rank r whatever its rows are, M = G Gᵀ of n×r. With W v = σ u the solution is φ = K⁻¹ G v /
// σ².
EigenPairs solve_semidefinite(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass,
                              Eigen::Index rank) {
  Eigen::VectorXd scale = mass.diagonal().cwiseSqrt();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  const auto pairs =
      support::solve_symmetric(scale.cwiseInverse().asDiagonal() * mass * scale.cwiseInverse().asDiagonal());
  if (!pairs || !(pairs->values(pairs->values.size() - rank) > kSmallestMass)) {
    throw support::NumericalError(
        "modes: more motions have no mass, to rounding, than freedoms have none; masses or moments of "
        "inertia "
        "that differ by many orders of magnitude are the usual cause: leave the tiny ones out");
  }
  const Eigen::MatrixXd G =
      scale.asDiagonal() * pairs->vectors.rightCols(rank) * pairs->values.tail(rank).cwiseSqrt().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> L = factor(stiffness, kStiffness);
  const support::SingularPairs singular = support::calc_right_singular_pairs(L.matrixL().solve(G));
  EigenPairs result;
  result.omega_squared = singular.values.cwiseAbs2().cwiseInverse();
  result.vectors = L.solve(G * singular.vectors) * result.omega_squared.asDiagonal();
  return result;
}

// Freedoms without mass first.
Eigen::VectorXi order_by_mass(const Eigen::MatrixXd& mass) {
  Eigen::VectorXi order =
      Eigen::VectorXi::LinSpaced(static_cast<int>(mass.rows()), 0, static_cast<int>(mass.rows()) - 1);
  std::stable_partition(order.begin(), order.end(), [&](int i) { return mass(i, i) == 0.0; });
  return order;
}

}  // namespace

EigenPairs solve_dense(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass,
                       Eigen::Index num_missing) {
  const Eigen::Index num_massless = (mass.diagonal().array() == 0.0).count();
  if (num_missing > num_massless) return solve_semidefinite(stiffness, mass, mass.rows() - num_missing);
  const Eigen::VectorXi order = order_by_mass(mass);
  const Eigen::Index num_modes = mass.rows() - num_massless;
  const Eigen::VectorXi massive = order.tail(num_modes);
  const Eigen::LLT<Eigen::MatrixXd> of_stiffness = factor(stiffness(order, order), kStiffness);
  const Eigen::LLT<Eigen::MatrixXd> of_mass = factor(mass(massive, massive), "mass");
  const Eigen::MatrixXd L = of_stiffness.matrixL(), G = of_mass.matrixL();
  const auto L_massive = L.bottomRightCorner(num_modes, num_modes).triangularView<Eigen::Lower>();
  // Singular values descend, so that frequencies ascend.
  const support::SingularPairs singular = support::calc_right_singular_pairs(L_massive.solve(G));
  const Eigen::VectorXd& sigma = singular.values;
  if (!sigma.allFinite() || !(sigma.minCoeff() > 0.0)) {
    throw support::NumericalError(
        "modes: a frequency is not finite; the stiffness matrix is singular to rounding");
  }
  EigenPairs pairs;
  pairs.omega_squared = sigma.cwiseAbs2().cwiseInverse();
  Eigen::MatrixXd ordered(mass.rows(), num_modes);
  ordered.bottomRows(num_modes) = of_mass.matrixU().solve(singular.vectors);
  ordered.topRows(num_massless) =
      -L.bottomLeftCorner(num_modes, num_massless).transpose() * ordered.bottomRows(num_modes);
  L.topLeftCorner(num_massless, num_massless)
      .triangularView<Eigen::Lower>()
      .transpose()
      .solveInPlace(ordered.topRows(num_massless));
  pairs.vectors.resize(mass.rows(), num_modes);
  pairs.vectors(order, Eigen::all) = ordered;
  return pairs;
}

}  // namespace sprung::reduce

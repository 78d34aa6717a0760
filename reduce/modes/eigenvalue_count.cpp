#include "reduce/modes/eigenvalue_count.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "reduce/modes/stiffness_factor.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

// LDLᵀ without pivoting can grow where a leading minor of the indefinite matrix is nearly singular; a
// solution whose residual is small shows that it did not.
constexpr double kResidualTolerance = 1e-6;

// K − σM of a held frame. Of a free one K − σM + σQQᵀ, with three more unknowns y = Qᵀx in place of the full
// matrix QQᵀ; their own entries −σ are three negative ones.
Eigen::SparseMatrix<double> make_shifted(const ModalProblem& problem, double omega_squared) {
  const Eigen::SparseMatrix<double> held = problem.stiffness - omega_squared * problem.mass;
  if (!problem.is_free()) return held;
  const auto n = static_cast<int>(problem.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index column = 0; column < held.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(held, column); entry; ++entry) {
      entries.emplace_back(static_cast<int>(entry.row()), static_cast<int>(entry.col()), entry.value());
    }
  }
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < n; ++i) {
      const double value = omega_squared * problem.rigid_share(i, j);
      entries.emplace_back(i, n + j, value);
      entries.emplace_back(n + j, i, value);
    }
    entries.emplace_back(n + j, n + j, -omega_squared);
  }
  Eigen::SparseMatrix<double> shifted(n + 3, n + 3);
  shifted.setFromTriplets(entries.begin(), entries.end());
  return shifted;
}

// That of the stiffness, where there is one; the unknowns y come last.
std::vector<int> choose_order(const ModalProblem& problem) {
  if (problem.factor == nullptr) return {};
  const std::span<const int> known = problem.factor->order();
  std::vector<int> order(known.begin(), known.end());
  const auto n = static_cast<int>(problem.size());
  for (int j = 0; problem.is_free() && j < 3; ++j) order.push_back(n + j);
  return order;
}

}  // namespace

int count_modes_below(const ModalProblem& problem, double omega_squared) {
  const Eigen::SparseMatrix<double> shifted = make_shifted(problem, omega_squared);
  const std::unique_ptr<SparseFactor> factors = make_sparse_factor(shifted, false, choose_order(problem));
  double residual = std::numeric_limits<double>::infinity();
  if (factors != nullptr) {
    // A load on every freedom, scaled by the diagonal so that forces and moments weigh alike.
    Eigen::VectorXd load = Eigen::VectorXd::Zero(shifted.rows());
    load.head(problem.size()) = problem.stiffness.diagonal().cwiseSqrt();
    const Eigen::VectorXd x = factors->solve(load);
    const Eigen::VectorXd scale = shifted.cwiseAbs() * x.cwiseAbs() + load;
    residual = (shifted * x - load).cwiseAbs().cwiseQuotient(scale).maxCoeff();
  }
  if (!(residual < kResidualTolerance)) {
    const std::string fault =
        std::isfinite(residual)
            ? fmt::format("relative residual {:.3g}, tolerance {:.0e}", residual, kResidualTolerance)
            : "a pivot vanishes";
    throw support::NumericalError(fmt::format(
        "count of modes below {:.9g} Hz: K − σM could not be factored, {}; ask for another number of modes",
        std::sqrt(omega_squared) / (2.0 * std::numbers::pi), fault));
  }
  const int num_rigid = problem.is_free() ? 3 : 0;
  return factors->num_negative() - num_rigid;
}

}  // namespace sprung::reduce

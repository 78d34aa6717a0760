#include "reduce/modes/eigenvalue_count.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

// LDLᵀ without pivoting can grow where a leading minor of the indefinite matrix is nearly singular; a
// solution whose residual is small shows that it did not.
constexpr double kResidualTolerance = 1e-6;

}  // namespace

int count_modes_below(const ModalProblem& problem, double omega_squared) {
  const Eigen::SparseMatrix<double> shifted = problem.stiffness - omega_squared * problem.mass;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(shifted);
  double residual = std::numeric_limits<double>::infinity();
  if (factors.info() == Eigen::Success && factors.vectorD().allFinite()) {
    // A load on every freedom, scaled by the diagonal so that forces and moments weigh alike.
    const Eigen::VectorXd load = problem.stiffness.diagonal().cwiseSqrt();
    const Eigen::VectorXd x = factors.solve(load);
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
  return static_cast<int>((factors.vectorD().array() < 0.0).count());
}

}  // namespace sprung::reduce

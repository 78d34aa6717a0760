#include "reduce/modes/eigenvalue_count.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "reduce/modes/stiffness_factor.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

// LDLᵀ without pivoting can grow where a leading minor of the indefinite matrix is nearly singular; a
// solution whose residual is small shows that it did not.
constexpr double kResidualTolerance = 1e-6;

// In the order of the stiffness, where it is known and the mass has no entries beside those of the stiffness.
std::unique_ptr<SparseFactor> factor_shifted(const ModalProblem& problem, const SparseMatrix& shifted) {
  const bool has_order = problem.factor != nullptr && shifted.nonZeros() == problem.stiffness.nonZeros();
  return has_order ? problem.factor->factor_like(shifted) : make_sparse_factor(shifted, false);
}

// The inertia of K − σM, for a free frame that of K − σM + σQQᵀ.
struct Inertia {
  int num_negative = 0;
  double residual = 0.0;  // by how much a solution misses its equations, beside their terms
};

double calc_largest(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& scale) {
  return residual.cwiseAbs().cwiseQuotient(scale).maxCoeff();
}

Inertia calc_held_inertia(const SparseMatrix& A, const SparseFactor& factor, const Eigen::VectorXd& load) {
  const Eigen::VectorXd x = factor.solve(load);
  return {.num_negative = factor.num_negative(),
          .residual = calc_largest(A * x - load, A.cwiseAbs() * x.cwiseAbs() + load)};
}

// With three more unknowns y = Qᵀx in place of the full matrix QQᵀ it is that of [A, B; Bᵀ, −σI], A = K − σM
// and B = σQ, without the three negative ones of −σI. By elimination of A it is that of A and of −σI −
// BᵀA⁻¹B.
Inertia calc_free_inertia(const SparseMatrix& A, const SparseFactor& factor, const Eigen::VectorXd& load,
                          const Eigen::MatrixXd& B, double sigma) {
  Eigen::MatrixXd loads(A.rows(), 4);
  loads << B, load;
  const Eigen::MatrixXd solved = factor.solve(loads);
  Eigen::Matrix3d corner = -B.transpose() * solved.leftCols<3>();
  corner = (0.5 * (corner + corner.transpose())).eval();
  corner.diagonal().array() -= sigma;
  const Eigen::VectorXd y = -corner.fullPivLu().solve(B.transpose() * solved.col(3));
  const Eigen::VectorXd x = solved.col(3) - solved.leftCols<3>() * y;
  const double of_frame =
      calc_largest(A * x + B * y - load, A.cwiseAbs() * x.cwiseAbs() + B.cwiseAbs() * y.cwiseAbs() + load);
  const double of_rigid = calc_largest(B.transpose() * x - sigma * y,
                                       B.cwiseAbs().transpose() * x.cwiseAbs() + sigma * y.cwiseAbs());
  const auto of_corner =
      static_cast<int>((corner.selfadjointView<Eigen::Lower>().eigenvalues().array() < 0.0).count());
  return {.num_negative = factor.num_negative() + of_corner - 3, .residual = std::max(of_frame, of_rigid)};
}

// A load on every freedom, scaled by the diagonal so that forces and moments weigh alike, shows the residual.
std::optional<Inertia> calc_inertia(const ModalProblem& problem, double sigma) {
  const SparseMatrix A = problem.stiffness - sigma * problem.mass;
  const std::unique_ptr<SparseFactor> factor = factor_shifted(problem, A);
  if (factor == nullptr) return {};
  const Eigen::VectorXd load = problem.stiffness.diagonal().cwiseSqrt();
  return problem.is_free() ? calc_free_inertia(A, *factor, load, sigma * problem.rigid_share, sigma)
                           : calc_held_inertia(A, *factor, load);
}

}  // namespace

int count_modes_below(const ModalProblem& problem, double omega_squared) {
  const std::optional<Inertia> inertia = calc_inertia(problem, omega_squared);
  const double residual = inertia ? inertia->residual : std::numeric_limits<double>::infinity();
  if (!(residual < kResidualTolerance)) {
    const std::string fault =
        std::isfinite(residual)
            ? fmt::format("relative residual {:.3g}, tolerance {:.0e}", residual, kResidualTolerance)
            : "a pivot vanishes";
    throw support::NumericalError(fmt::format(
        "count of modes below {:.9g} Hz: K − σM could not be factored, {}; ask for other modes or another "
        "highest_frequency",
        std::sqrt(omega_squared) / (2.0 * std::numbers::pi), fault));
  }
  return inertia->num_negative;
}

}  // namespace sprung::reduce

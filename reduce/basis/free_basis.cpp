#include "reduce/basis/free_basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reduce/certificate/band_errors.h"
#include "reduce/factors/sparse_factor.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kFarBelow = 0.1;       // of the tolerance: errors below need no sharp bound for a choice
constexpr double kTie = 1e-6;           // shares nearer than this count as equal: the first load is taken
constexpr Eigen::Index kFewLoads = 60;  // up to which a small body's residual vectors are chosen one by one
constexpr double kSmallestStaticShare = 1e-3;  // below which vectors chosen together depend on each other
constexpr double kNegligibleMissing = 1e-10;   // share at rest below which a load adds no direction

// Adds a vector, and says from what it was made.
void add_vector(InterfaceResidual& residual, const ResidualSource& source,
                std::vector<ResidualSource>& added) {
  residual.add(residual.make_vector(source.load, source.omega_squared));
  added.push_back(source);
}

// The static response to every load, in their order.
void add_all(InterfaceResidual& residual, std::vector<ResidualSource>& added) {
  for (Eigen::Index load = 0; load < residual.num_loads(); ++load) {
    const double missing = residual.calc_errors(0.0, residual.calc_amplitudes(0.0))(load);
    if (missing > kNegligibleMissing * residual.static_flexibility()(load))
      add_vector(residual, {.load = load}, added);
  }
}

// The first of the loads with the largest share.
Eigen::Index find_worst(const Eigen::VectorXd& shares) {
  const double largest = shares.maxCoeff();
  Eigen::Index worst = 0;
  while (shares(worst) < (1.0 - kTie) * largest) ++worst;
  return worst;
}

// Static responses, chosen together as they would be one by one: the worst load at rest joins until no share
// is above the tolerance. What the responses chosen leave of the others is a Cholesky factorisation of the
// loads' work with pivoting.
void add_static(InterfaceResidual& residual, double tolerance, std::vector<ResidualSource>& added) {
  const Eigen::MatrixXd work = residual.calc_load_work();
  const Eigen::VectorXd allowed =
      tolerance * residual.static_flexibility().cwiseMax(std::numeric_limits<double>::min());
  Eigen::VectorXd missing = work.diagonal();
  Eigen::MatrixXd factor(work.rows(), work.cols());
  std::vector<Eigen::Index> chosen;
  while (true) {
    const Eigen::Index worst = find_worst(missing.cwiseQuotient(allowed));
    if (missing(worst) <= allowed(worst)) break;
    const auto k = static_cast<Eigen::Index>(chosen.size());
    factor.col(k) = (work.col(worst) - factor.leftCols(k) * factor.row(worst).head(k).transpose()) /
                    std::sqrt(missing(worst));
    missing -= factor.col(k).cwiseAbs2();
    missing(worst) = 0.0;
    chosen.push_back(worst);
    added.push_back({.load = worst});
  }
  Eigen::MatrixXd vectors(residual.size(), std::ssize(chosen));
  for (Eigen::Index k = 0; k < vectors.cols(); ++k)
    vectors.col(k) = residual.make_vector(chosen[static_cast<std::size_t>(k)], 0.0);
  if (!chosen.empty()) residual.add(std::move(vectors));
}

// Why the basis does not get better with as many vectors as there are motions.
const char* name_obstacle(const ModalProblem& problem) {
  if (problem.num_massless == 0) return "rounding keeps it from getting better; ask for a larger tolerance";
  return "no other motion has mass: give points without mass of their own, as at the end of a spring, a "
         "[[point_masses]], or lines more elements, or take the basis \"fixed-interface\", or ask for a "
         "larger tolerance";
}

// @param num_left  motions with mass that are no free modes of the basis
void add_until_certified(InterfaceResidual& residual, const ModalProblem& problem, double highest,
                         double cutoff, double tolerance, Eigen::Index num_left, const Progress& progress,
                         std::vector<ResidualSource>& added) {
  while (residual.num_loads() > 0) {
    if (progress) progress(fmt::format("residual vector {}", residual.num_vectors() + 1));
    const BandErrors errors = calc_band_errors(residual, highest, cutoff, kFarBelow * tolerance);
    const Eigen::VectorXd shares = errors.error.cwiseQuotient(
        residual.static_flexibility().cwiseMax(std::numeric_limits<double>::min()));
    const Eigen::Index worst = find_worst(shares);
    if (shares(worst) <= tolerance) return;
    if (residual.num_vectors() >= num_left) {
      throw support::NumericalError(
          fmt::format("the basis misses {:.3g} of an interface flexibility with {} residual vectors, "
                      "tolerance {:.3g}: {}",
                      shares(worst), residual.num_vectors(), tolerance, name_obstacle(problem)));
    }
    add_vector(residual, {.load = worst, .omega_squared = errors.worst_omega_squared(worst)}, added);
  }
}

}  // namespace

FreeBodyBasis make_free_basis(const ModalProblem& problem, const StiffnessFactor& factor,
                              const ModesBelow& modes, const BasisRequest& request) {
  const CertificateRequest certificate{.interface = request.interface,
                                       .frame_loads = request.frame_loads,
                                       .highest_hz = request.highest_hz,
                                       .tolerance = request.tolerance,
                                       .free_modes = modes.pairs,
                                       .next_omega_squared = modes.next_omega_squared,
                                       .holds_free_modes = true,
                                       .is_complete = modes.pairs.omega_squared.size() == problem.size(),
                                       .rounding = request.rounding};
  InterfaceResidual residual(problem, factor, modes.pairs, request.loads);
  const Eigen::Index k = modes.pairs.omega_squared.size();
  FreeBodyBasis basis;
  if (!certificate.is_complete) {
    if (request.all_residual) add_all(residual, basis.residuals);
    const double highest = std::pow(2.0 * std::numbers::pi * request.highest_hz, 2);
    const bool is_large = residual.size() > kMostSimplicial || residual.num_loads() > kFewLoads;
    if (is_large && residual.num_loads() > 0 && residual.num_vectors() == 0)
      add_static(residual, std::max(request.tolerance, kSmallestStaticShare), basis.residuals);
    add_until_certified(residual, problem, highest, calc_cutoff(certificate), request.tolerance,
                        problem.num_modes() - k, request.progress, basis.residuals);
  }
  const EigenPairs ritz = residual.ritz();
  const Eigen::Index m = ritz.omega_squared.size();
  basis.vectors = {.omega_squared = Eigen::VectorXd(k + m),
                   .vectors = Eigen::MatrixXd(problem.size(), k + m)};
  basis.vectors.omega_squared << modes.pairs.omega_squared, ritz.omega_squared;
  if (k > 0) basis.vectors.vectors.leftCols(k) = modes.pairs.vectors;
  if (m > 0) basis.vectors.vectors.rightCols(m) = ritz.vectors;
  basis.kind.assign(static_cast<std::size_t>(k), kFreeVector);
  basis.kind.insert(basis.kind.end(), static_cast<std::size_t>(m), kResidualVector);
  basis.certificate = calc_certificate(residual, certificate);
  return basis;
}

}  // namespace sprung::reduce

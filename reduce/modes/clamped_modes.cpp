#include "reduce/modes/clamped_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "reduce/modes/clusters.h"
#include "reduce/modes/dense_eigen_solver.h"
#include "reduce/modes/eigenvalue_count.h"
#include "reduce/modes/sparse_eigen_solver.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr int kAlwaysDense = 300;  // up to this many freedoms the dense solution is the quicker one
constexpr int kAttempts = 6;

bool take_dense(Eigen::Index n, Eigen::Index wanted, EigenMethod method) {
  if (method == EigenMethod::kDense || wanted >= n) return true;
  if (method == EigenMethod::kSparse) return false;
  return n <= kAlwaysDense || (n <= kMaxDenseSize && 3 * wanted > n);
}

EigenPairs solve_all(const ModalProblem& problem) {
  if (problem.size() > kMaxDenseSize) {
    throw support::NumericalError(fmt::format(
        "modes: a dense solution is offered up to {} freedoms, the frame has {}; ask for fewer modes or "
        "refine the mesh less",
        kMaxDenseSize, problem.size()));
  }
  return solve_dense(problem.stiffness,
                     problem.times_mass(Eigen::MatrixXd::Identity(problem.size(), problem.size())),
                     problem.num_massless);
}

// A frequency squared between two modes: in the middle of the gap, but beyond everything that would belong to
// the lower one's cluster.
double choose_shift(double below, double above) {
  const double lower = std::sqrt(below), upper = std::sqrt(above);
  const double step = std::max(0.5 * (upper - lower), std::min(kClusterGap * upper, 0.9 * (upper - lower)));
  return (lower + step) * (lower + step);
}

ClampedModes take(const EigenPairs& pairs, const Eigen::VectorXi& cluster, Eigen::Index num) {
  ClampedModes modes;
  modes.pairs = {.omega_squared = pairs.omega_squared.head(num), .vectors = pairs.vectors.leftCols(num)};
  modes.cluster = cluster.head(num);
  modes.num_below = static_cast<int>(num);
  return modes;
}

}  // namespace

ModeProof prove_complete(const ModalProblem& problem, const EigenPairs& pairs, int num_modes) {
  const Eigen::Index found = pairs.omega_squared.size();
  const Eigen::VectorXi cluster = find_clusters(pairs.omega_squared);
  const Eigen::Index end = find_cluster_of(cluster, num_modes - 1).end;
  if (end == problem.num_modes()) return {.modes = take(pairs, cluster, end), .reason = {}};
  if (end == found) {
    return {.modes = {},
            .reason = fmt::format("the cluster of mode {} at {:.6g} Hz goes on after mode {}", num_modes,
                                  calc_frequency_hz(pairs.omega_squared(end - 1)), found)};
  }
  const double shift = choose_shift(pairs.omega_squared(end - 1), pairs.omega_squared(end));
  const int counted = count_modes_below(problem, shift);
  if (counted != end) {
    return {.modes = {},
            .reason = fmt::format("{} modes found below {:.6g} Hz, {} counted", end, calc_frequency_hz(shift),
                                  counted)};
  }
  ClampedModes modes = take(pairs, cluster, end);
  modes.proof_hz = calc_frequency_hz(shift);
  modes.num_below = counted;
  return {.modes = std::move(modes), .reason = {}};
}

ClampedModes calc_clamped_modes(const ModalProblem& problem, int num_modes,
                                const ClampedModeOptions& options) {
  const Eigen::Index n = problem.num_modes();
  if (!(num_modes >= 1 && num_modes <= n)) {
    throw std::invalid_argument(
        fmt::format("calc_clamped_modes: num_modes is {}, expected 1 … {}", num_modes, n));
  }
  std::string reason;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    // Some more than wanted: the gap above the last one has to be seen, and guards quicken the convergence.
    const Eigen::Index wanted = std::min<Eigen::Index>(n, num_modes + (Eigen::Index{4} << attempt));
    const bool dense = take_dense(n, wanted, options.method);
    options.report_progress(fmt::format("{} modes of {} freedoms", dense ? n : wanted, problem.size()));
    const EigenPairs pairs = dense ? solve_all(problem)
                                   : solve_sparse(problem, static_cast<int>(wanted),
                                                  options.seed + static_cast<std::uint64_t>(attempt));
    options.report_progress("count of the modes");
    ModeProof proof = prove_complete(problem, pairs, num_modes);
    if (proof.modes) return std::move(*proof.modes);
    reason = std::move(proof.reason);
    if (dense) break;
  }
  throw support::NumericalError(fmt::format(
      "modes: no complete set of {} modes could be proved: {}; refine the mesh less or ask for another "
      "number of modes",
      num_modes, reason));
}

}  // namespace sprung::reduce

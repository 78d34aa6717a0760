#include "reduce/modes/modes_below.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "reduce/factors/sparse_factor.h"
#include "reduce/modes/clusters.h"
#include "reduce/modes/eigenvalue_count.h"
#include "reduce/modes/sparse_eigen_solver.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

// The count, a little higher where a mode is so near that the matrix is singular to rounding.
int count_below(const ModalProblem& problem, double omega_squared) {
  constexpr int kSearches = 4;
  for (int attempt = 1; attempt < kSearches; ++attempt) {
    try {
      return count_modes_below(problem, omega_squared);
    } catch (const support::NumericalError&) {
      omega_squared *= 1.0 + 1e-4 * attempt;
    }
  }
  return count_modes_below(problem, omega_squared);
}

// The modes below a value and the next one, as the iteration itself finds them: then one count proves them,
// and none is needed to know how many they are. None where the proof fails.
std::optional<ClampedModes> find_uncounted(const ModalProblem& problem, double omega_squared,
                                           const ClampedModeOptions& options) {
  if (problem.size() <= kMostSimplicial || options.method == EigenMethod::kDense) return std::nullopt;
  options.report_progress(fmt::format("modes of {} freedoms", problem.size()));
  const EigenPairs pairs = solve_sparse_below(problem, omega_squared, options.seed);
  const auto num_below = static_cast<int>((pairs.omega_squared.array() < omega_squared).count());
  options.report_progress("count of the modes");
  return prove_complete(problem, pairs, num_below + 1).modes;
}

}  // namespace

ModesBelow calc_modes_below(const ModalProblem& problem, double frequency_hz,
                            const ClampedModeOptions& options) {
  const auto n = static_cast<int>(problem.num_modes());
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  std::optional<ClampedModes> uncounted = find_uncounted(problem, omega * omega, options);
  int wanted = 0;
  if (uncounted) {
    wanted = static_cast<int>((uncounted->pairs.omega_squared.array() < omega * omega).count());
  } else {
    options.report_progress(fmt::format("count of the modes below {:.3g} Hz", frequency_hz));
    wanted = count_below(problem, omega * omega);
  }
  while (true) {
    const ClampedModes found = uncounted ? *std::exchange(uncounted, std::nullopt)
                                         : calc_clamped_modes(problem, std::min(wanted + 1, n), options);
    const auto num_found = static_cast<int>(found.cluster.size());
    const auto end = wanted == 0 ? 0 : static_cast<int>(find_cluster_of(found.cluster, wanted - 1).end);
    if (end == num_found && num_found < n) {  // the next one was of the same cluster
      wanted = end;
      continue;
    }
    ModesBelow below;
    below.pairs = {.omega_squared = found.pairs.omega_squared.head(end),
                   .vectors = found.pairs.vectors.leftCols(end)};
    below.cluster = found.cluster.head(end);
    if (end < num_found) below.next_omega_squared = found.pairs.omega_squared(end);
    below.proof_hz = found.proof_hz;
    below.num_missing = found.num_below - num_found;
    return below;
  }
}

}  // namespace sprung::reduce

#include "reduce/modes/wanted_modes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "reduce/modes/clusters.h"
#include "reduce/modes/eigenvalue_count.h"

namespace sprung::reduce {

namespace {

using support::InputError;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

int count_modes_up_to(const ModesUpTo& wanted, const WantedModes& request, const ModalProblem& problem,
                      const ClampedModeOptions& options) {
  // A frequency that is the mode's own, as printed or copied, is meant to take it.
  const double omega = kTwoPi * wanted.frequency_hz * (1.0 + kClusterGap);
  const int count = count_modes_below(problem, omega * omega);
  if (count > 0) return count;
  const ClampedModes lowest = calc_clamped_modes(problem, 1, options);
  throw InputError(request.where,
                   fmt::format("no mode has a frequency up to {:.6g} Hz; the lowest is at {:.6g} Hz",
                               wanted.frequency_hz, calc_frequency_hz(lowest.pairs.omega_squared(0))));
}

}  // namespace

int calc_num_modes_needed(const WantedModes& request, const ModalProblem& problem,
                          const ClampedModeOptions& options) {
  const int n = static_cast<int>(problem.num_modes());
  if (const auto* up_to = std::get_if<ModesUpTo>(&request.wanted)) {
    return count_modes_up_to(*up_to, request, problem, options);
  }
  if (std::holds_alternative<AllModes>(request.wanted)) {
    if (n <= kMaxDenseSize) return n;
    throw InputError(request.where,
                     fmt::format("all modes were asked of a frame with {} freedoms; that is offered up "
                                 "to {}: ask for a number of modes or a highest frequency",
                                 n, kMaxDenseSize));
  }
  const auto* count = std::get_if<ModeCount>(&request.wanted);
  const int needed = count ? count->count : std::get<ModeNumbers>(request.wanted).numbers.back();
  if (needed <= n) return needed;
  throw InputError(
      request.where,
      fmt::format("mode {} was asked for, but the frame has {} elastic freedoms, hence modes 1 … {}", needed,
                  n, n));
}

std::vector<int> select_modes(const WantedModes& request, const ClampedModes& modes, int num_needed) {
  if (const auto* chosen = std::get_if<ModeNumbers>(&request.wanted)) {
    std::vector<int> columns;
    for (const int number : chosen->numbers) columns.push_back(number - 1);
    return columns;
  }
  if (const ModeRange range = find_cluster_of(modes.cluster, num_needed - 1); range.end > num_needed) {
    throw InputError(
        request.where,
        fmt::format("{} modes would take part of the cluster of modes {} … {}, which have one frequency, "
                    "{:.6g} Hz; take {} or {} modes, or name them by 'numbers'",
                    num_needed, range.begin + 1, range.end,
                    calc_frequency_hz(modes.pairs.omega_squared(range.begin)), range.begin, range.end));
  }
  std::vector<int> columns(static_cast<std::size_t>(num_needed));
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

}  // namespace sprung::reduce

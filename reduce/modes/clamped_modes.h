#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "reduce/modes/eigen_pairs.h"

namespace sprung::reduce {

enum class EigenMethod { kAutomatic, kDense, kSparse };

/// Is told what a calculation of minutes is at.
using Progress = std::function<void(const std::string& state)>;

struct ClampedModeOptions {
  EigenMethod method = EigenMethod::kAutomatic;  ///< automatic: dense where it is the cheaper or the only way
  std::uint64_t seed = 1;                        ///< of the sparse method's start vector
  Progress progress = {};                        ///< may be empty

  void report_progress(const std::string& state) const {
    if (progress) progress(state);
  }
};

/// The lowest modes of a held frame, proved to be all of them.
struct ClampedModes {
  EigenPairs pairs;         ///< k ≥ the number asked for: the last one's cluster is whole
  Eigen::VectorXi cluster;  ///< k, as from find_clusters
  double proof_hz =
      0.0;            ///< frequency in the gap above the last mode where they were counted; 0: all n modes
  int num_below = 0;  ///< modes counted below it (eigenvalue_count.h), k
};

/// Solves for the lowest modes and counts them independently. While the count differs, or no gap above the
/// last cluster was found, it solves again for more modes. A basis that is not proved complete is never
/// returned.
///
/// @param num_modes  1 … n
/// @throws support::NumericalError if no complete basis was found after several attempts (numbers found and
///         counted)
/// @throws std::invalid_argument if num_modes is out of range
/// Checked by tests/reduce/modes/clamped_modes_test.cpp
ClampedModes calc_clamped_modes(const ModalProblem& problem, int num_modes,
                                const ClampedModeOptions& options = {});

/// Whether the solutions found are complete up to the end of the last wanted mode's cluster.
struct ModeProof {
  std::optional<ClampedModes> modes;  ///< where they are complete: the modes up to there
  std::string reason;                 ///< where they are not: the numbers found and counted
};

/// Counts the modes below a frequency in the gap above the last wanted one's cluster and compares.
///
/// @param pairs      solutions found, ascending, at least num_modes
/// @param num_modes  wanted, ≥ 1
/// @throws support::NumericalError if the count cannot be made (eigenvalue_count.h)
/// Checked by tests/reduce/modes/clamped_modes_test.cpp
ModeProof prove_complete(const ModalProblem& problem, const EigenPairs& pairs, int num_modes);

/// The largest n for which all modes can be asked for: the dense solution of a larger problem takes too much
/// time and memory.
inline constexpr int kMaxDenseSize = 3000;

}  // namespace sprung::reduce

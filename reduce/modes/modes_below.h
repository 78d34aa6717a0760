#pragma once

#include <limits>

#include "reduce/modes/clamped_modes.h"

namespace sprung::reduce {

/// All modes below a frequency, and the next one.
struct ModesBelow {
  EigenPairs pairs;         ///< k
  Eigen::VectorXi cluster;  ///< k, as from find_clusters
  /// ω² of the mode k + 1; infinite where there is none
  double next_omega_squared = std::numeric_limits<double>::infinity();
  double proof_hz = 0.0;  ///< where they were counted, as in ClampedModes
  int num_missing = 0;    ///< counted below proof_hz and not found: 0
};

/// The modes below a frequency, proved to be all by their count. A cluster at the frequency is taken whole.
///
/// @param frequency_hz  > 0
/// @throws support::NumericalError as calc_clamped_modes
/// Checked by tests/reduce/modes/free_body_test.cpp
ModesBelow calc_modes_below(const ModalProblem& problem, double frequency_hz,
                            const ClampedModeOptions& options = {});

}  // namespace sprung::reduce

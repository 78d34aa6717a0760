#pragma once

#include <Eigen/Core>

#include "dynamics/integration/exponential/collocation_step.h"

namespace sprung::dynamics {

/// Estimate of the error that the steps of a run leave in the pairs that vibrate
/// (integration/exponential, eq. 8): the error of each step vibrates on as the pairs do. f pairs.
class VibrationError {
 public:
  explicit VibrationError(Eigen::Index num_pairs);

  /// Carries the error over a step and adds what the step leaves. @param to_end  of the step
  void add_step(const CollocationStep& step, const LobattoPropagator& to_end, const PairBlocks& blocks);
  /// The error within the last step. @param to_instant  of it   @param[out] u  2f
  void calc_within(const CollocationStep& step, const LobattoPropagator& to_instant, const PairBlocks& blocks,
                   Eigen::VectorXd& u) const;
  const Eigen::VectorXd& at_end() const { return at_end_; }  ///< of the last step, 2f
  /// For a change of the pairs. @param u  the same error in the new ones, 2f
  void set_at_end(const Eigen::Ref<const Eigen::VectorXd>& u) { at_end_ = u; }

 private:
  Eigen::VectorXd at_start_, at_end_;  // of the last step, 2f
};

}  // namespace sprung::dynamics

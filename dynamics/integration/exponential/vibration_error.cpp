#include "dynamics/integration/exponential/vibration_error.h"

namespace sprung::dynamics {

VibrationError::VibrationError(Eigen::Index num_pairs)
    : at_start_(Eigen::VectorXd::Zero(2 * num_pairs)), at_end_(at_start_) {}

void VibrationError::add_step(const CollocationStep& step, const LobattoPropagator& to_end,
                              const PairBlocks& blocks) {
  static const double largest = lobatto::node_polynomial(0.5);
  at_start_ = at_end_;
  to_end.carry_error(blocks, largest, step.quartic.u, at_end_);
}

void VibrationError::calc_within(const CollocationStep& step, const LobattoPropagator& to_instant,
                                 const PairBlocks& blocks, Eigen::VectorXd& u) const {
  u = at_start_;
  to_instant.carry_error(blocks, 0.0, step.quartic.u, u);
  to_instant.add_quartic(blocks, step.quartic.u, u);
}

}  // namespace sprung::dynamics

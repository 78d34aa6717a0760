#include "dynamics/integration/exponential/step_switches.h"

#include <cmath>

#include "dynamics/integration/hidden_switches.h"
#include "dynamics/integration/throw_stopped.h"

namespace sprung::dynamics {

namespace {

constexpr double kRicher = 100.0;         // of the error allowed: a smaller deviation hides no switch
constexpr double kShortestHiding = 1e-9;  // s

// The motion of a step at the instant of a propagator.
void propagate(const CollocationStep& step, const LobattoPropagator& propagator, const PairBlocks& blocks,
               PairedMotion& motion) {
  step.propagate(propagator, blocks, motion);
  step.add_quartic(propagator, blocks, motion);
}

}  // namespace

StepSwitches::StepSwitches(OdeSystem& system, const PairedMotion& motion)
    : system_(system),
      values_(Eigen::MatrixXd::Zero(system.num_switches(), lobatto::kNumNodes)),
      search_(system.num_switches()),
      propagator_(motion.u.size() / 2),
      motion_(motion),
      y_(Eigen::VectorXd::Zero(system.size())),
      between_(Eigen::VectorXd::Zero(system.num_switches())) {
  probe_propagators_.fill(propagator_);
  for (std::size_t k = 0; k < kProbes.size(); ++k) probe_weights_[k] = lobatto::cubic_weights(kProbes[k]);
}

bool StepSwitches::evaluate(double time, std::span<const double> y, int node) {
  return system_.calc_switches(time, y, {values_.col(node).data(), static_cast<std::size_t>(values_.rows())});
}

bool StepSwitches::evaluate_at(double time, Eigen::VectorXd& values) {
  return system_.calc_switches(time, {y_.data(), static_cast<std::size_t>(y_.size())},
                               {values.data(), static_cast<std::size_t>(values.size())});
}

bool StepSwitches::crosses() const {
  for (int j = 1; j < lobatto::kNumNodes; ++j) {
    if (SwitchSearch::any_crosses(values_.col(j - 1), values_.col(j))) return true;
  }
  return false;
}

void StepSwitches::move_to_probe(const CollocationStep& step, const PairCoordinates& coordinates,
                                 std::size_t probe) {
  propagate(step, probe_propagators_[probe], coordinates.blocks(), motion_);
}

bool StepSwitches::may_hide(const CollocationStep& step, const Stages& stages,
                            const PairCoordinates& coordinates) {
  if (step.length < kShortestHiding) return false;
  for (Eigen::Index i = 0; i < values_.rows(); ++i) {
    if (std::isfinite(SwitchCourse(values_.row(i)).dip())) return true;
  }
  if (step.length != probe_length_) {
    for (std::size_t k = 0; k < kProbes.size(); ++k)
      probe_propagators_[k].update(kProbes[k], step.length, coordinates.blocks());
    probe_length_ = step.length;
  }
  // Whether the motion is richer than the cubic through the nodes.
  bool is_richer = false;
  for (std::size_t k = 0; k < kProbes.size() && !is_richer; ++k) {
    move_to_probe(step, coordinates, k);
    const lobatto::NodeWeights& weights = probe_weights_[k];
    const auto difference = motion_.u - weights[0] * step.motion.u - weights[1] * stages[1].u -
                            weights[2] * stages[2].u - weights[3] * stages[3].u;
    is_richer = coordinates.estimate_norm(difference) > kRicher;
  }
  if (!is_richer) return false;
  for (std::size_t k = 0; k < kProbes.size(); ++k) {
    move_to_probe(step, coordinates, k);
    coordinates.to_state(motion_, step, kProbes[k] * step.length, y_);
    if (!evaluate_at(step.start + kProbes[k] * step.length, between_)) return true;
    for (Eigen::Index i = 0; i < values_.rows(); ++i) {
      if (SwitchCourse(values_.row(i)).may_hide(kProbes[k], between_[i])) return true;
    }
  }
  return false;
}

double StepSwitches::locate(const CollocationStep& step, const PairCoordinates& coordinates, double tolerance,
                            PairedMotion& motion) {
  int after = 1;
  while (after < lobatto::kNumNodes && !SwitchSearch::any_crosses(values_.col(after - 1), values_.col(after)))
    ++after;
  double place = -1.0;  // of `motion`
  const auto move_to = [&](double theta) {
    place = theta;
    propagator_.update(theta, step.length, coordinates.blocks());
    propagate(step, propagator_, coordinates.blocks(), motion);
  };
  const double theta = search_.locate(lobatto::nodes(), values_, after, tolerance / step.length,
                                      [&](double at, Eigen::VectorXd& values) {
                                        move_to(at);
                                        coordinates.to_state(motion, step, at * step.length, y_);
                                        const double time = step.start + at * step.length;
                                        if (!evaluate_at(time, values))
                                          throw_stopped(time, "no positions can be found there");
                                      });
  if (theta != place) move_to(theta);
  return theta;
}

}  // namespace sprung::dynamics

#include "dynamics/integration/exponential/collocation_step.h"

namespace sprung::dynamics {

using lobatto::combine;
using lobatto::cubic_weights;
using lobatto::kNumNodes;
using lobatto::node;
using lobatto::node_polynomial;

CollocationStep::CollocationStep(Eigen::Index num_pairs, Eigen::Index num_quadratures)
    : motion{Eigen::VectorXd::Zero(2 * num_pairs), Eigen::VectorXd::Zero(num_quadratures)},
      drive{lobatto::NodeValues::Zero(2 * num_pairs, kNumNodes),
            lobatto::NodeValues::Zero(num_quadratures, kNumNodes)},
      quartic(motion) {}

void CollocationStep::propagate(const LobattoPropagator& propagator, const PairBlocks& blocks,
                                PairedMotion& at) const {
  propagator.apply(blocks, motion.u, drive.pairs, at.u);
  at.w = motion.w;
  for (int j = 0; j < kNumNodes; ++j) at.w += propagator.integral_weight(j) * drive.rates.col(j);
}

void CollocationStep::add_quartic(const LobattoPropagator& propagator, const PairBlocks& blocks,
                                  PairedMotion& at) const {
  if (!has_quartic) return;
  propagator.add_quartic(blocks, quartic.u, at.u);
  at.w += propagator.integral_quartic() * quartic.w;
}

void CollocationStep::calc_drive(double theta, PairedMotion& at) const {
  const lobatto::NodeWeights weights = cubic_weights(theta);
  combine(drive.pairs, weights, at.u);
  combine(drive.rates, weights, at.w);
}

void CollocationStep::propagate_quartic(const LobattoPropagator& propagator, const PairBlocks& blocks,
                                        PairedMotion& at) const {
  at.u.setZero();
  propagator.add_quartic(blocks, quartic.u, at.u);
  at.w = propagator.integral_quartic() * quartic.w;
}

DrivePrediction::DrivePrediction(Eigen::Index num_pairs, Eigen::Index num_quadratures) {
  const CollocationStep step(num_pairs, num_quadratures);
  expected_ = step.drive;
  jump_ = difference_ = at_ = step.motion;
}

void DrivePrediction::predict(const CollocationStep& last, Past past, CollocationStep& now) {
  Drive& drive = now.drive;
  const double ratio = past == Past::kNone ? 0.0 : now.length / last.length;
  const double origin = past == Past::kNone ? 0.0 : (now.start - last.start) / last.length;
  if (past == Past::kSwitched) {
    last.calc_drive(origin, at_);
    jump_.u = drive.pairs.col(0) - at_.u;
    jump_.w = drive.rates.col(0) - at_.w;
  }
  std::array<double, kNumNodes> shape{};  // of the error that is left
  for (int j = 1; j < kNumNodes; ++j) {
    const double theta = origin + node(j) * ratio;
    shape[static_cast<std::size_t>(j)] = past == Past::kSmooth ? node_polynomial(theta) : node(j);
    if (past == Past::kNone) {
      drive.pairs.col(j) = drive.pairs.col(0);
      drive.rates.col(j) = drive.rates.col(0);
      continue;
    }
    last.calc_drive(theta, at_);
    drive.set(j, at_);
    if (past == Past::kSwitched) {
      drive.pairs.col(j) += jump_.u;
      drive.rates.col(j) += jump_.w;
    } else if (last.has_quartic) {
      drive.pairs.col(j) += node_polynomial(theta) * last.quartic.u;
      drive.rates.col(j) += node_polynomial(theta) * last.quartic.w;
    }
  }
  expected_ = drive;
  weights_(2, 1) = shape[2] / shape[1];
  weights_(3, 1) = shape[3] / shape[1];
  weights_(3, 2) = shape[3] / shape[2] * (node(3) - node(1)) / (node(2) - node(1));
}

void DrivePrediction::correct(int from, CollocationStep& now) {
  difference_.u = now.drive.pairs.col(from) - expected_.pairs.col(from);
  difference_.w = now.drive.rates.col(from) - expected_.rates.col(from);
  for (int j = from + 1; j < kNumNodes; ++j) {
    expected_.pairs.col(j) += weights_(j, from) * difference_.u;
    expected_.rates.col(j) += weights_(j, from) * difference_.w;
    now.drive.pairs.col(j) = expected_.pairs.col(j);
    now.drive.rates.col(j) = expected_.rates.col(j);
  }
}

}  // namespace sprung::dynamics

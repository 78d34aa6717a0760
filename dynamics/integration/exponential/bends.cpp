#include "dynamics/integration/exponential/bends.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

using lobatto::cubic_weights;
using lobatto::kNumNodes;
using lobatto::node;

constexpr double kPlaceTolerance = 1e-9;  // of the step

double calc_power(double value, int order) {
  return order == 1 ? value : value * std::abs(value);
}

}  // namespace

void Bend::add_response(double theta, double length, const PairBlocks& blocks, LobattoPropagator& propagator,
                        PairedMotion& motion) const {
  const double part = theta - place;
  if (!(part > 0.0)) return;
  propagator.update(1.0, part * length, blocks);
  lobatto::NodeWeights values;
  double weight = 0.0;
  for (int j = 0; j < kNumNodes; ++j) {
    values[j] = cubic_weights(place + node(j) * part).dot(shape);
    weight += propagator.integral_weight(j) * calc_power(values[j], power_order);
  }
  propagator.add_response(blocks, gain.u, values, motion.u);
  motion.w += weight * gain.w;
}

void Bend::add_gain(double theta, PairedMotion& drive) const {
  const double value = cubic_weights(theta).dot(shape);
  drive.u += value * gain.u;
  drive.w += calc_power(value, power_order) * gain.w;
}

double Bend::calc_doubt(double length) const {
  constexpr double kBetweenLineAndParabola = 1.0 / 2.0 - 1.0 / 3.0;
  return power_order == 1 ? kBetweenLineAndParabola * (1.0 - place) * length : 0.0;
}

Bends::Bends(Eigen::Index num_pairs, Eigen::Index num_quadratures) {
  for (Bend& bend : bends_)
    bend.gain = {Eigen::VectorXd::Zero(2 * num_pairs), Eigen::VectorXd::Zero(num_quadratures)};
}

bool Bends::find(const OdeSystem& system, const Eigen::MatrixXd& switches, SwitchSearch& search) {
  clear();
  for (int i = 0; i < static_cast<int>(switches.rows()); ++i) {
    int after = 0, num_crossings = 0;
    for (int j = 1; j < kNumNodes; ++j) {
      if (!SwitchSearch::crosses(switches(i, j - 1), switches(i, j))) continue;
      after = j;
      ++num_crossings;
    }
    if (num_crossings == 0) continue;
    const double last = switches(i, kNumNodes - 1);
    const Passage passage = system.passage(i);
    if (num_crossings > 1 || last >= 0.0 || passage == Passage::kJump || size_ == kMaxBends) {
      clear();
      return false;
    }
    Bend& bend = bends_[size_++];
    bend.switch_index = i;
    bend.power_order = passage == Passage::kBend ? 1 : 2;
    bend.place = search.find_crossing(lobatto::nodes(), switches, after, i, kPlaceTolerance);
    bend.shape = switches.row(i).transpose() / last;
  }
  std::sort(bends_.begin(), bends_.begin() + static_cast<std::ptrdiff_t>(size_),
            [](const Bend& a, const Bend& b) { return a.place < b.place; });
  return true;
}

Bend& Bends::add_echo() {
  Bend& echo = bends_[size_++];
  echo.power_order = 1;
  echo.place = bends_[0].place;
  for (int j = 0; j < kNumNodes; ++j) {
    const double share = (node(j) - echo.place) / (1.0 - echo.place);
    echo.shape[j] = share * share;
  }
  return echo;
}

}  // namespace sprung::dynamics

// Switches within a step of the exponential method.
#include <algorithm>
#include <cmath>

#include "dynamics/integration/exponential/exponential_integrator.h"
#include "dynamics/integration/hidden_switches.h"

namespace sprung::dynamics {

namespace {

// Place of a switch: late by this, at a tolerance of 1, a force that sets in wrongs the velocity by far less
// than is allowed.
constexpr double kSwitchTolerance = 1e-4;        // s
constexpr double kLeastSwitchTolerance = 1e-12;  // s

constexpr double kSurprise = 100.0;       // of what is allowed: less than that hides no switch worth finding
constexpr double kShortestHiding = 1e-9;  // s

std::span<double> span_of(Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

}  // namespace

// What is about to become valid may not be so yet by a rounding error: what it does then must not be missed.
void ExponentialIntegrator::begin_switches(int node) {
  switches_.col(0) = switches_.col(node).cwiseMax(0.0);
}

bool ExponentialIntegrator::crosses() const {
  for (int j = 1; j < kNumNodes; ++j) {
    if (SwitchSearch::any_crosses(switches_.col(j - 1), switches_.col(j))) return true;
  }
  return false;
}

// The motion of now_ at the instant of a propagator, into between_motion_.
void ExponentialIntegrator::move_between(const LobattoPropagator& propagator) {
  now_.propagate(propagator, basis_.blocks, between_motion_);
  now_.add_quartic(propagator, basis_.blocks, between_motion_);
}

// Whether the motion at one of kLooks is another than the cubic through the nodes tells.
bool ExponentialIntegrator::is_surprising(std::size_t look) {
  move_between(lookers_[look]);
  const lobatto::NodeWeights& weights = look_weights_[look];
  const auto difference = between_motion_.u - weights[0] * now_.motion.u - weights[1] * stages_[1].u -
                          weights[2] * stages_[2].u - weights[3] * stages_[3].u;
  return pair_sizes_.cwiseProduct(difference).norm() > kSurprise;
}

// Whether in now_ a switch function may become negative and positive again and no node show it: what vibrates
// is stepped over exactly, however often.
bool ExponentialIntegrator::may_hide_switches() {
  if (now_.length < kShortestHiding) return false;
  for (Eigen::Index i = 0; i < switches_.rows(); ++i) {
    if (std::isfinite(SwitchCourse(switches_.row(i)).dip())) return true;
  }
  if (now_.length != looker_length_) {
    for (std::size_t k = 0; k < kLooks.size(); ++k) lookers_[k].update(kLooks[k], now_.length, basis_.blocks);
    looker_length_ = now_.length;
  }
  bool looks = false;
  for (std::size_t k = 0; k < kLooks.size(); ++k) looks = looks || is_surprising(k);
  if (!looks) return false;
  for (std::size_t k = 0; k < kLooks.size(); ++k) {
    move_between(lookers_[k]);
    to_physical(between_motion_, stage_y_);
    const double time = now_.start + kLooks[k] * now_.length;
    if (!system_.calc_switches(time, span_of(stage_y_), span_of(end_switches_))) return true;
    for (Eigen::Index i = 0; i < switches_.rows(); ++i) {
      if (SwitchCourse(switches_.row(i)).may_hide(kLooks[k], end_switches_[i])) return true;
    }
  }
  return false;
}

// The first zero of a switch function in now_, between two of its nodes. time_ and between_motion_ are there.
void ExponentialIntegrator::locate_switch() {
  int after = 1;
  while (after < kNumNodes && !SwitchSearch::any_crosses(switches_.col(after - 1), switches_.col(after)))
    ++after;
  double place = 0.0;  // of between_motion_
  const auto move_to = [&](double theta) {
    place = theta;
    between_.update(theta, now_.length, basis_.blocks);
    move_between(between_);
  };
  const double tolerance =
      std::max({kSwitchTolerance * tolerance_, kLeastSwitchTolerance, 4e-16 * std::abs(time_)}) / now_.length;
  const double theta =
      switch_search_.locate(lobatto::nodes(), switches_, after, tolerance, [&](double at, Vector& values) {
        move_to(at);
        to_physical(between_motion_, stage_y_);
        const double time = now_.start + at * now_.length;
        if (!system_.calc_switches(time, span_of(stage_y_), span_of(values))) {
          throw_stopped(time, "no positions can be found there");
        }
      });
  time_ = now_.start + theta * now_.length;
  if (theta != place) move_to(theta);
}

}  // namespace sprung::dynamics

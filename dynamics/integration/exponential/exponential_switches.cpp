// Switches within a step of the exponential method: carried through where forces bend, else located.
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

constexpr double kBendShare = 1.0;  // error of a step that is carried through bends, of what is allowed
constexpr double kDisturbance =
    5.0;  // what a bend may do up to the next, of what is allowed: little of it comes back
constexpr double kSurprise = 100.0;       // of what is allowed: less than that hides no switch worth finding
constexpr double kShortestHiding = 1e-9;  // s

constexpr double kLeastBendContraction = 0.1, kLargestBendContraction = 0.9;

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
  if (!crosses()) return false;
  // Bends change the forces at the end: the equations have to be there.
  constexpr int kEnd = kNumNodes - 1;
  to_physical(stages_[kEnd], stage_y_);
  return !evaluate(now_.start + now_.length, stages_[kEnd], kEnd);
}

// Whether the bends before a place do next to nothing up to there: only then is it where it seems to be, and
// may what is called for in turn be found at the end alone.
bool ExponentialIntegrator::is_undisturbed(double place) {
  difference_.set_zero();
  for (const Bend& bend : now_.bends.all()) {
    bend.add_response(place, now_.length, basis_.blocks, between_, difference_);
  }
  return calc_norm(difference_) <= kDisturbance;
}

// The bends of now_ and what they do at its end, in bend_response_. That motion changes the drive in turn,
// and so on, each time by about the same share: the second time is looked at where it counts. @return false
// where what is left is too much
bool ExponentialIntegrator::find_gains() {
  constexpr int kEnd = kNumNodes - 1;
  const double end = now_.start + now_.length;
  bend_response_.set_zero();
  doubt_.set_zero();
  for (Bend& bend : now_.bends.all()) {
    if (&bend != now_.bends.all().data() && !is_undisturbed(bend.place)) return false;
    if (!system_.pass(bend.switch_index, now_.start + bend.place * now_.length, span_of(y_dot_)))
      return false;
    basis_.to_pairs(y_dot_.data(), bend.gain.u.data());
    bend.gain.w = y_dot_.tail(num_quadratures_);
    bend.add_response(1.0, now_.length, basis_.blocks, between_, bend_response_);
    doubt_.w += bend.calc_doubt(now_.length) * bend.gain.w;
  }
  const double doubt = calc_norm(doubt_), first = calc_norm(bend_response_);
  const auto is_enough = [&](double size) {
    return doubt + size * bend_contraction_ / (1.0 - bend_contraction_) <= kBendShare;
  };
  // All that has been passed to has to hold at the end.
  const auto holds = [&] { return switches_.col(kEnd).minCoeff() >= 0.0; };
  if (is_enough(first)) {
    return system_.calc_switches(end, span_of(stage_y_),
                                 {switches_.col(kEnd).data(), static_cast<std::size_t>(num_switches_)}) &&
           holds();
  }
  between_motion_.u = end_.u + bend_response_.u;
  between_motion_.w = end_.w + bend_response_.w;
  to_physical(between_motion_, stage_y_);
  if (!evaluate(end, between_motion_, kEnd) || !holds()) return false;
  difference_.u = now_.drive.pairs.col(kEnd) - end_drive_.u;
  difference_.w = now_.drive.rates.col(kEnd) - end_drive_.w;
  for (const Bend& bend : now_.bends.all()) {
    difference_.u -= bend.gain.u;
    difference_.w -= bend.gain.w;
  }
  Bend& echo = now_.bends.add_echo();
  echo.gain = difference_;
  difference_.set_zero();
  echo.add_response(1.0, now_.length, basis_.blocks, between_, difference_);
  bend_response_.u += difference_.u;
  bend_response_.w += difference_.w;
  const double second = calc_norm(difference_);
  bend_contraction_ = std::clamp(second / first, kLeastBendContraction, kLargestBendContraction);
  return is_enough(second);
}

// Carries now_ through forces that only bend in it. @return false, and nothing changed, where that will not
// do
bool ExponentialIntegrator::pass_bends() {
  if (!now_.bends.find(system_, switches_, switch_search_)) return false;
  const auto num_bends = static_cast<long>(now_.bends.all().size());
  now_.drive.get(kNumNodes - 1, end_drive_);
  end_switches_ = switches_.col(kNumNodes - 1);
  const bool good = find_gains();
  now_.drive.set(kNumNodes - 1, end_drive_);
  if (good) {
    statistics_.bends += num_bends;
  } else {
    now_.bends.clear();
    system_.take_back_passes();
    switches_.col(kNumNodes - 1) = end_switches_;
  }
  return good;
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

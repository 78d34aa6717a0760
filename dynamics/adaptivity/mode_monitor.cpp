#include "dynamics/adaptivity/mode_monitor.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kLongestGap = 4e-3;  // s between updates
constexpr double kMostParts = 8.0;    // of a step, with an update at the end of each

}  // namespace

ModeMonitor::ModeMonitor(const AdaptivityOptions& options, const dynamics::State& start)
    : modes_(options, start),
      motion_(*options.full, start),
      record_(modes_.indicator(), start.time),
      missing_(modes_.indicator(), options.points,
               options.changes ? MissingStart{.is_balanced = false} : options.missing, options.judged_from,
               options.judged_to),
      rates_(start.v),
      unbalanced_(static_cast<Eigen::Index>(modes_.indicator().num_modes())),
      largest_(modes_.indicator().num_modes()) {}

void ModeMonitor::update(double time, const HeldModes& held, const ConstrainedEquations& equations) {
  motion_.take(held, equations);
  modes_.update(time, equations, motion_.q(), motion_.v(), motion_.v_dot());
  rates_ = motion_.v();
  update_unbalanced(time);
  missing_.add(modes_.indicator(), unbalanced_, motion_.q(), motion_.v());
}

// The equations of the run have −r of the modes that joined as a force that fades; those of the full model do
// not.
void ModeMonitor::update_unbalanced(double time) {
  const ModeIndicator& indicator = modes_.indicator();
  for (std::size_t j = 0; j < indicator.num_modes(); ++j)
    unbalanced_[static_cast<Eigen::Index>(j)] = indicator.unbalanced_force(j);
  for (const FadingForce& fading : motion_.fading()) {
    const std::size_t mode = indicator.mode_of(fading.coordinate);
    if (indicator.active()[mode]) unbalanced_[static_cast<Eigen::Index>(mode)] -= fading.value(time);
  }
}

double ModeMonitor::let_leave(const std::vector<int>& coordinates, const std::vector<int>& branches) {
  modes_.deactivate(coordinates);
  const double lost =
      motion_.stop(coordinates, motion_.hold(modes_.active()), modes_.indicator().time(), branches);
  missing_.add_rates(rates_ - motion_.v());
  return lost;
}

void ModeMonitor::get_state(State& state) const {
  modes_.get_state(state.modes);
  missing_.get_state(state.missing);
}

void ModeMonitor::set_state(const State& state) {
  modes_.set_state(state.modes);
  missing_.set_state(state.missing);
}

void ModeMonitor::begin_step() {
  largest_ = modes_.indicator().amplitudes();
}

bool ModeMonitor::follow_step(SystemStepper& stepper, const HeldModes& held) {
  const bool may_miss = modes_.options().changes;
  const double begin = modes_.indicator().time(), end = stepper.time(), length = end - begin;
  if (!(length > 0.0)) return false;
  const int parts = static_cast<int>(std::clamp(std::ceil(length / kLongestGap), 1.0, kMostParts));
  bool misses = may_miss && modes_.misses_any();  // forces may have jumped at its start
  for (int i = 1; i <= parts; ++i) {
    const double time = i == parts ? end : begin + length * i / parts;
    if (i == parts) {
      stepper.evaluate_end_approximately(SystemStepper::Level::kAccelerations);
    } else {
      stepper.evaluate(time, SystemStepper::Level::kAccelerations);
    }
    update(time, held, stepper.equations());
    update_largest();
    misses |= may_miss && modes_.misses_any();
  }
  return misses;
}

void ModeMonitor::save(support::ByteWriter& bytes) const {
  modes_.save(bytes);
  motion_.save(bytes);
  record_.save(bytes);
  missing_.save(bytes);
}

void ModeMonitor::restore(support::ByteReader& bytes) {
  modes_.restore(bytes);
  motion_.restore(bytes);
  record_.restore(bytes, modes_.indicator());
  missing_.restore(bytes);
}

void ModeMonitor::update_largest() {
  for (std::size_t j = 0; j < largest_.size(); ++j) {
    const ModeAmplitude& now = modes_.indicator().amplitudes()[j];
    largest_[j] = {std::max(largest_[j].amplitude, now.amplitude),
                   std::max(largest_[j].acceleration, now.acceleration)};
  }
}

}  // namespace sprung::dynamics

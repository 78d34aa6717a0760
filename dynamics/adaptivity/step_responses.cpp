#include "dynamics/adaptivity/step_responses.h"

#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kSameStep = 1e-9;  // relative: times of equal steps differ by rounding

}  // namespace

void StepResponses::clear() {
  *this = StepResponses();
}

void StepResponses::add(double stiffness, double decay) {
  stiffness_.push_back(stiffness);
  decay_.push_back(decay);
  step_ = 0.0;
}

void StepResponses::prepare(double step) {
  if (std::abs(step - step_) <= kSameStep * step) return;
  responses_.resize(stiffness_.size());
  calc_oscillator_responses(stiffness_, decay_, step, 1, responses_);
  step_ = step;
}

void StepResponses::advance(std::size_t i, double before, double now, double& x, double& rate) const {
  const OscillatorResponse& r = responses_[i];
  const double slope = (now - before) / step_, start = x;
  x = r.c * start + r.s * rate + r.forced[0] * before + r.forced[1] * slope;
  rate = r.c_rate * start + r.s_rate * rate + r.forced_rate(0) * before + r.forced_rate(1) * slope;
}

}  // namespace sprung::dynamics

#pragma once

#include <vector>

#include "dynamics/functions/oscillator_response.h"

namespace sprung::dynamics {

/// The exact responses of several oscillators to a step, kept while steps have the same length.
class StepResponses {
 public:
  void clear();
  /// @param stiffness  ω² ≥ 0 [1/s²]   @param decay  d ≥ 0 [1/s]
  void add(double stiffness, double decay);
  std::size_t size() const { return stiffness_.size(); }
  double stiffness(std::size_t i) const { return stiffness_[i]; }
  double decay(std::size_t i) const { return decay_[i]; }

  /// Prepares a step. @param step  > 0 [s]
  void prepare(double step);
  /// Continues one oscillator through the step, in which the force on it changes linearly.
  void advance(std::size_t i, double before, double now, double& x, double& rate) const;

 private:
  std::vector<double> stiffness_, decay_;
  std::vector<OscillatorResponse> responses_;
  double step_ = 0.0;
};

}  // namespace sprung::dynamics

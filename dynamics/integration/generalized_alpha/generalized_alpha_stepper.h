#pragma once

#include <Eigen/Core>

#include "dynamics/integration/generalized_alpha/change_point_passage.h"
#include "dynamics/integration/generalized_alpha/generalized_alpha_step.h"
#include "dynamics/integration/stepping_options.h"
#include "dynamics/integration/switch_search.h"
#include "dynamics/integration/system_stepper.h"
#include "dynamics/integration/touch_search.h"

namespace sprung::dynamics {

/// Generalized-α on the constrained system itself: positions, velocities, accelerations and multipliers
/// of all coordinates, the constraints on the level of positions, no partition (system, eqs. 9, 10;
/// integration/generalized_alpha, eqs. 1, 2, 4–8). Second order. Velocities and accelerations satisfy their
/// constraints to the order of the method only: `evaluate` closes positions and velocities, takes out
/// vibration that the steps do not resolve, and finds accelerations and multipliers, without touching what is
/// integrated. Source: [Arnold & Brüls 2007]; variable step as in [Jay & Negrut 2009]
class GeneralizedAlphaStepper final : public SystemStepper {
 public:
  /// @param model  has to outlive this
  /// @throws std::invalid_argument for a spectral radius outside 0 … 1
  GeneralizedAlphaStepper(const Model& model, double relative_tolerance,
                          const GeneralizedAlphaOptions& options);

  void start(const State& state) override;
  void resume(double time, double end_time) override;
  Integrator::StepResult step(double longest_step) override;
  double time() const override { return time_; }
  double calc_longest_step() const override {
    return piece_.calc_longest_step(step_.residual().terms(), time_);
  }
  void evaluate(double time, Level level) override;
  const ConstrainedEquations& equations() const override { return equations_; }
  EnergyFlow energy_flow() const override { return {energy_.x(), energy_.y()}; }
  SmoothPiece& piece() override { return piece_; }
  Statistics statistics() const override;

  /// What is integrated, at the end of the last step: before anything is closed.
  const ConstrainedMotion& motion() const { return has_step_ ? step_.end().motion : step_.begin().motion; }

 private:
  using Vector = Eigen::VectorXd;
  using Pair = GeneralizedAlphaStep::Pair;

  double choose_length(double longest_step) const;
  void finish_step(double length);
  bool locate_switch();
  bool evaluate_equations(const ConstrainedMotion& motion);
  Pair calc_power();
  bool update_end_power();
  bool evaluate_within_step(double time);
  bool remove_vibration(double time);
  bool evaluate_closed(double time, const Vector& q, const Vector& v);
  bool pass_change_point_if_near(double longest_step);
  bool pass_change_point(double longest_step);
  Integrator::StepResult end_passage() const;
  void evaluate_passage(double time);
  void leave_piece(bool at_switch);
  void calc_exact(GeneralizedAlphaStep::End& end, double shift);

  const Model* model_;
  GeneralizedAlpha method_;
  double spectral_radius_, fixed_step_;
  SmoothPiece piece_;
  ConstrainedEquations equations_;  // at the state evaluated last, until the next `step`
  Statistics statistics_;
  long num_evaluations_ = 0;  // of the equations, without those for outputs

  GeneralizedAlphaStep step_;  // being made, or made last
  bool has_step_ = false;
  double time_ = 0.0, end_time_ = 0.0, next_length_;
  Pair energy_ = Pair::Zero();  // at the time evaluated last [J]

  ChangePointPassage passage_;   // the last step, where that was one over a change point
  ChangePointStep::End inside_;  // it

  // Work space.
  Vector interpolated_q_, interpolated_v_;
  GeneralizedAlphaStep::End exact_, departure_;  // where the last piece ended
  bool has_departure_ = false;
  bool has_modes_;
  ConstrainedMotion probe_;   // a little after or before a start; within a step
  Eigen::MatrixXd switches_;  // num_switches × 2: at the start and at the end of a step
  SwitchSearch switch_search_;
  TouchSearch touch_search_;
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>

#include "dynamics/analysis/error_scales.h"
#include "dynamics/analysis/generalized_alpha.h"
#include "dynamics/analysis/switch_search.h"
#include "dynamics/analysis/system_stepper.h"
#include "dynamics/system/index3_newton.h"
#include "dynamics/system/index3_residual.h"

namespace sprung::dynamics {

/// Generalized-α on the constrained system as it stands: positions, velocities, accelerations and multipliers
/// of all coordinates, the constraints on the level of positions, no partition (dynamics/README.md, eqs.
/// 57–62). Second order. Velocities and accelerations satisfy their constraints to the order of the method
/// only: `evaluate` closes positions and velocities and finds accelerations and multipliers from them,
/// without touching what is integrated. Source: [Arnold & Brüls 2007]; variable step as in [Jay & Negrut
/// 2009]
class GeneralizedAlphaStepper final : public SystemStepper {
 public:
  /// @param model  has to outlive this
  /// @throws std::invalid_argument for a spectral radius outside 0 … 1
  GeneralizedAlphaStepper(const Model& model, const Integrator::Options& options);

  void start(const State& state) override;
  void resume(double end_time) override;
  Integrator::StepResult step(double longest_step) override;
  double time() const override { return time_; }
  double calc_longest_step() const override { return piece_.calc_longest_step(residual_.terms()); }
  void evaluate(double time) override;
  const ConstrainedEquations& equations() const override { return equations_; }
  EnergyFlow energy_flow() const override { return {evaluated_energy_.x(), evaluated_energy_.y()}; }
  SmoothPiece& piece() override { return piece_; }
  Statistics statistics() const override;

  /// What is integrated, at the end of the last step: before anything is closed.
  const ConstrainedMotion& motion() const { return has_step_ ? end_.motion : begin_.motion; }

 private:
  using Vector = Eigen::VectorXd;
  using Pair = Eigen::Vector2d;  // dissipated, put in

  // One end of a step.
  struct Node {
    explicit Node(const Model& model, int num_switches);
    ConstrainedMotion motion;
    Vector lead;  // (a − v̇) over the step's length: the same for the next step, whatever its length
    Vector jerk;  // of a, over the step that ended here; at a start that of the motion
    Vector lambda_rate;  // likewise
    Pair energy, power, power_rate;
    double step_before = 0.0;  // length of that step, 0 at a start [s]
    Vector switches;
  };

  double choose_length(double longest_step) const;
  void predict(double length);
  void apply_auxiliary(double length);
  bool iterate(double length);
  bool converge(double length);
  void renew_matrix(const Index3Newton::Weights& weights);
  Index3Newton::Weights weights(double length) const;
  double rounding(int i) const;
  double allowed_position(int i) const;
  double allowed_velocity(int i, double length) const;
  double calc_iteration_norm(double length) const;
  void filter_error(Vector& error);
  double calc_error(double length);
  void finish_step(double length);
  bool locate_switch();
  void interpolate(double time);
  void evaluate_equations(const ConstrainedMotion& motion);
  Pair calc_power();
  void update_end_power();
  void find_rates();

  const Model* model_;
  GeneralizedAlpha method_;
  double tolerance_, fixed_step_;
  ErrorScales scales_;
  SmoothPiece piece_;
  ConstrainedEquations
      equations_;            // at the state evaluated last; between evaluations wherever they are needed
  Index3Residual residual_;  // of the step
  Index3Newton newton_;
  Statistics statistics_;
  long num_evaluations_ = 0;  // of the equations

  Node begin_, end_;  // of the step being made, or made last
  bool has_step_ = false;
  double time_ = 0.0, end_time_ = 0.0, next_length_;
  double evaluated_time_ = 0.0;
  Pair evaluated_energy_ = Pair::Zero();

  // What of Newton's matrix is renewed before the next iteration.
  enum class Renewal { kNone, kFactors, kAll };
  Renewal renewal_ = Renewal::kAll;
  bool is_fresh_ = false;     // renewed in this step
  double contraction_ = 0.0;  // of the last iteration

  Vector auxiliary_begin_, auxiliary_end_;  // a, nq
  Vector delta_, delta_lambda_, scaled_phi_, q_, v_, probe_;
  SwitchSearch switch_search_;
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

#include "dynamics/integration/exponential/collocation_step.h"
#include "dynamics/integration/exponential/pair_coordinates.h"
#include "dynamics/integration/exponential/step_switches.h"
#include "dynamics/integration/exponential/vibration_error.h"
#include "dynamics/integration/integrator.h"

namespace sprung::dynamics {

/// Exponential collocation. Small motion about an earlier state is decomposed into uncoupled pairs, which are
/// solved exactly whatever their frequency and damping. The rest of the accelerations is a cubic over the
/// step through its values at the four Lobatto points, found by iteration. So the length of a step follows
/// the excitation of stiff modes, not their period. Order 6 at the ends of steps, 4 within. No step needs
/// those before it: after a switch the step stays as long as it was. Source: variation of constants;
/// [Hochbruck & Ostermann 2010] (integration/exponential, eqs. 1–9).
class ExponentialIntegrator final : public Integrator {
 public:
  /// @param system  f > 0 freedoms; has to outlive this
  ExponentialIntegrator(OdeSystem& system, double relative_tolerance);

  void start(double time, std::span<const double> y, double end_time) override;
  StepResult step(double longest_step) override;
  double largest_gap() const override { return lobatto::node(2) - lobatto::node(1); }
  double time() const override { return time_; }
  std::span<const double> y() const override { return {y_.data(), static_cast<std::size_t>(y_.size())}; }
  void interpolate(double time, std::span<double> y) const override;
  bool estimate_acceleration_error(double time, Eigen::VectorXd& error) const override;
  Statistics statistics() const override { return statistics_; }
  const SmallMotion* small_motion() const override { return wants_linearisation_ ? nullptr : &small_motion_; }

 private:
  static constexpr int kNumNodes = lobatto::kNumNodes;
  using Vector = Eigen::VectorXd;

  void linearise();
  void begin();
  void update_pairs();
  bool aim_shear();
  double choose_length(double longest_step) const;
  bool evaluate(double time, const PairedMotion& motion, int node);
  void estimate_quartic();
  bool iterate();
  double calc_change(std::size_t node, PairedMotion& motion);
  double calc_truncation();
  void update_propagators();
  bool is_surprise(double error) const;
  void give_up_iteration();
  void renew_linearisation();
  bool has_outlived_linearisation() const;
  bool finish_step();
  void locate_switch();

  OdeSystem& system_;
  double tolerance_;
  Statistics statistics_;

  SmallMotion small_motion_;
  PairCoordinates coordinates_;
  int version_ = 0;  // of the coordinates in y that the pairs are for
  bool wants_linearisation_ = true;
  long last_linearisation_ = 0;  // step
  double failures_ = 0.0;        // of the pairs; those of earlier steps count less and less

  double time_ = 0.0, end_time_ = 0.0;
  Vector y_;                    // at time_
  CollocationStep now_, last_;  // being made; finished
  StepSwitches switches_;       // of now_
  StepSwitches::Stages stages_;
  DrivePrediction prediction_;
  bool has_begun_ = false;
  Past past_ = Past::kNone;
  double next_length_ = 0.0;
  double hiding_length_ = std::numeric_limits<double>::infinity();  // steps of this length may hide switches
  double contraction_;                                              // of the iteration, from sweep to sweep
  double last_error_ = 0.0;                                         // of the step before, of the tolerance
  std::array<LobattoPropagator, kNumNodes> propagators_;            // to each node but the first
  double propagator_length_ = 0.0;

  VibrationError vibration_error_;  // at time_
  PairedMotion end_;                // motion at the end of now_, when its iteration is over
  // Work space.
  Vector y_dot_, stage_y_, error_sizes_;
  PairedMotion again_, change_;        // of a sweep: the motion at its second node anew, what has changed
  PairedMotion drive_at_, truncated_;  // a drive within a step; the effect of the quartic
  PairedMotion at_switch_;
  Eigen::MatrixXd mass_columns_;  // for the shear of the pairs
  mutable LobattoPropagator between_;
  mutable double between_time_ = std::numeric_limits<double>::quiet_NaN();  // that it is for
  mutable PairedMotion between_motion_;
  mutable Vector between_y_, error_pairs_, error_rates_, error_change_;
};

}  // namespace sprung::dynamics

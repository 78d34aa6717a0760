#pragma once

#include <Eigen/Core>

#include "dynamics/integration/error_scales.h"
#include "dynamics/integration/generalized_alpha/generalized_alpha.h"
#include "dynamics/integration/smooth_piece.h"
#include "dynamics/system/index3_newton.h"
#include "dynamics/system/index3_residual.h"

namespace sprung::dynamics {

/// One step of generalized-α on the index-3 system: what holds at its two ends, Newton's iteration between
/// them and the error that it makes (system, eqs. 9, 10; integration/generalized_alpha, eqs. 1, 2, 5, 7, 8).
/// Allocates nothing where Index3Newton does not.
class GeneralizedAlphaStep {
 public:
  using Vector = Eigen::VectorXd;
  using Pair = Eigen::Vector2d;  ///< of dissipated energy and of what is put in

  /// One end of a step.
  struct End {
    End(const Model& model, int num_switches);
    ConstrainedMotion motion;
    Vector lead;  ///< (a − v̇) over the step's length: the same for the next step, whatever its length
    Vector jerk;  ///< of a, over the step that ended here; at a start that of the motion
    Vector mean_velocity;            ///< of positions, over the step that ended here
    Vector lambda_rate;              ///< likewise
    Pair energy, power, power_rate;  ///< [J, W, W/s]
    double step_before = 0.0;        ///< length of the step that ended here, 0 at a start [s]
    Vector switches;
  };

  /// @param model, piece  have to outlive this
  /// @param tolerance     relative, of ErrorScales
  GeneralizedAlphaStep(const Model& model, const SmoothPiece& piece, const GeneralizedAlpha& method,
                       double tolerance);

  End& begin() { return begin_; }
  const End& begin() const { return begin_; }
  End& end() { return end_; }
  const End& end() const { return end_; }
  void reset();    ///< as if newly made
  void advance();  ///< the end becomes the beginning

  /// Smallest pivot of φ_q, of that at a regular position: rounding errors grow by its inverse.
  void set_smallest_pivot(double pivot) { smallest_pivot_ = pivot; }

  /// Finds the motion at the end of a step of this length. @return false where the iteration does not
  /// converge
  bool solve(double length);
  /// Error of the step solved last, as a share of what is allowed; the power of its end has to be set.
  double calc_error(double length);
  /// Makes the next step factor the matrix at its own positions.
  void renew_factors() {
    if (renewal_ == Renewal::kNone) renewal_ = Renewal::kFactors;
  }
  /// Completes the end for the step after it.
  void finish(double length, double end_time);
  /// Positions and velocities within the step, these without vibration that the step does not resolve.
  void interpolate_motion(double time, Vector& q, Vector& v);
  Pair interpolate_energy(double time) const;  ///< likewise [J]
  /// Moves positions within the step to where the joints close and the accelerations of the equations lack
  /// the vibration that the step does not resolve (integration/generalized_alpha, eq. 6).
  /// @param v_dot, phi  accelerations of the equations and residuals of the constraints at q
  void remove_vibration(double time, const Vector& v_dot, const Vector& phi, Vector& q);
  /// How far accelerations, multipliers and their rates within the step are from those that the equations
  /// give at the positions and velocities there.
  void calc_departure(const End& exact, End& departure) const;
  void depart(const End& departure);  ///< adds it to the beginning

  Index3Residual& residual() { return residual_; }  ///< at the motion before the iteration's last change
  const Index3Residual& residual() const { return residual_; }
  long iteration_failures() const { return iteration_failures_; }

 private:
  void predict(double length);
  void apply_auxiliary(double length);
  bool iterate(double length);
  bool renew_matrix(const Index3Newton::Weights& weights);
  Index3Newton::Weights weights(double length) const;
  double rounding(int i) const;
  double allowed_position(int i) const;
  double allowed_velocity(int i, double length) const;
  double calc_iteration_norm(double length) const;
  void settle_velocities(double place, Vector& v);
  void filter_error(const Vector& error, const Vector& scaled_phi, Vector& filtered);

  const Model* model_;
  const SmoothPiece* piece_;
  GeneralizedAlpha method_;
  double tolerance_, smallest_pivot_ = 1.0;
  ErrorScales scales_;
  Index3Residual residual_;
  Index3Newton newton_;
  End begin_, end_;

  // The part of Newton's matrix that is renewed before the next iteration.
  enum class Renewal { kNone, kFactors, kAll };
  Renewal renewal_ = Renewal::kAll;
  Index3Newton::Weights factored_weights_;
  bool is_fresh_ = false;     // renewed in this step
  double contraction_ = 0.0;  // of the last iteration
  long iteration_failures_ = 0;

  Vector auxiliary_begin_, auxiliary_end_;  // a, nq
  Vector delta_;                            // of the accelerations, by the last iteration, nq
  Vector delta_lambda_, scaled_phi_;        // m
  Vector vibration_;                        // of velocities, nq
  // Of filter_error: errors as they are and without the parts that do not count, and Newton's right-hand side
  // and multipliers for these.
  Vector error_, error_q_, error_v_, error_force_;  // nq
  Vector error_lambda_, no_violation_;              // m
};

}  // namespace sprung::dynamics

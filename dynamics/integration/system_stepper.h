#pragma once

#include "dynamics/integration/integrator.h"
#include "dynamics/integration/smooth_piece.h"
#include "dynamics/system/constrained_equations.h"

namespace sprung::dynamics {

/// Carries a state of the constrained system forward in time, in whatever unknowns. It integrates the smooth
/// piece that holds; between pieces the caller chooses the next one and lets it resume.
class SystemStepper {
 public:
  /// Energy that has left and entered the mechanical energy since the start [J].
  struct EnergyFlow {
    double dissipated = 0.0, input = 0.0;
  };
  struct Statistics {
    Integrator::Statistics integrator;
    long evaluations = 0;  ///< of the equations, by the integrator
    long repartitions = 0;
    double velocity_violation = 0.0;  ///< largest |φ_q v + φ_t| of a step's end that was closed for output

    Statistics& operator+=(const Statistics& later);  ///< of steppers one after the other
  };

  /// All there is to see at one instant, until the next call of anything else.
  struct Observation {
    /// The equations of the model that is run: positions, mass, velocities and accelerations up to date, all
    /// markers.
    const ConstrainedEquations& equations;
    /// In coordinates of the model that the run was given; modes that are held in the other are at rest.
    const Eigen::VectorXd &q, &v, &v_dot;
    double held_strain = 0.0;  ///< strain energy of modes that are held [J]
  };

  virtual ~SystemStepper() = default;

  /// Small motion about a state like that which the run starts from, for who treats it apart. Before `start`.
  virtual void suggest(KnownMotion) {}
  /// Takes over a state that satisfies the constraints. Its branches are those of piece() from then on.
  virtual void start(const State& state) = 0;
  /// Goes on from where `evaluate` or `evaluate_motion` was called last with the branches of piece(), up to
  /// `end_time`.
  /// @throws support::NumericalError where there are no accelerations
  virtual void resume(double end_time) = 0;
  /// One step of at most `longest_step`.
  /// @throws support::NumericalError with the time and the reason
  virtual Integrator::StepResult step(double longest_step) = 0;
  virtual double time() const = 0;  ///< end of the last step, or of its part up to a switch
  /// Longest step that the piece would not regret, at the state evaluated last [s].
  virtual double calc_longest_step() const = 0;

  /// Brings equations() and energy_flow() to a time within the last step: joints closed, accelerations and
  /// multipliers those of the equations; markers that joints and forces see.
  /// @throws support::NumericalError if the joints cannot be closed
  virtual void evaluate(double time) = 0;
  /// `evaluate` without accelerations and multipliers, which what comes next need not ask for.
  virtual void evaluate_motion(double time) { evaluate(time); }
  /// Brings equations() to the end of the last step, or leaves them as near to it as the last iterate that
  /// the integrator tried there: for who watches, not for who goes on from it.
  virtual void look() { evaluate(time()); }
  /// `evaluate`, and what it has come to with all markers.
  virtual Observation observe(double time) = 0;
  virtual const ConstrainedEquations& equations() const = 0;  ///< until the next `step` or `resume`
  virtual EnergyFlow energy_flow() const = 0;

  virtual SmoothPiece& piece() = 0;
  virtual Statistics statistics() const = 0;
};

}  // namespace sprung::dynamics

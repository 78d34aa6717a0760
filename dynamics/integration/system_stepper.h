#pragma once

#include <optional>

#include "dynamics/integration/integrator.h"
#include "dynamics/integration/smooth_piece.h"
#include "dynamics/system/constrained_equations.h"

namespace sprung::dynamics {

/// Integrates the constrained system in time, in unknowns of its own choice, as long as the equations are
/// smooth (SmoothPiece). Between two smooth pieces the caller chooses the next one and lets it resume.
class SystemStepper {
 public:
  /// Energy that has left and entered the mechanical system since the start [J].
  struct EnergyFlow {
    double dissipated = 0.0, input = 0.0;
  };
  struct Statistics {
    Integrator::Statistics integrator;
    long evaluations = 0;  ///< of the equations, by the integrator
    long repartitions = 0;
    double velocity_violation =
        0.0;  ///< largest |φ_q v + φ_t| of the integrated motion, where it is evaluated

    Statistics& operator+=(const Statistics& later);  ///< adds those of a stepper that has taken over
  };

  /// What `evaluate` brings up to date; each level contains those before it.
  enum class Level {
    kMotion,         ///< joints closed, positions and velocities of the markers that joints and forces see
    kAccelerations,  ///< accelerations and multipliers
    kAllMarkers,     ///< positions and velocities of the markers that only results ask for
  };

  /// The motion evaluated last, until the next call of anything else.
  struct Observation {
    const ConstrainedEquations& equations;  ///< of the model that is run
    /// In coordinates of the model that the run was given; modes that are held in the other are at rest.
    const Eigen::VectorXd &q, &v, &v_dot;
    double held_strain = 0.0;  ///< strain energy of modes that are held [J]
  };

  virtual ~SystemStepper() = default;

  /// Small motion about a state near the one that `start` will get, for methods that treat it separately.
  virtual void set_small_motion(KnownMotion) {}
  /// The small motion in use, for methods that treat it separately.
  virtual std::optional<KnownMotion> small_motion() const { return std::nullopt; }
  /// Takes over the one that another stepper of the same model has used, after `evaluate` at the start.
  virtual void continue_small_motion(const KnownMotion&) {}
  /// Takes over a state that satisfies the constraints. Its branches are those of piece() from then on.
  virtual void start(const State& state) = 0;
  /// Restarts at `time`, at which `evaluate` was called last, with the branches of piece(), up to `end_time`.
  /// @throws support::NumericalError where there are no accelerations
  virtual void resume(double time, double end_time) = 0;
  /// One step of at most `longest_step`.
  /// @throws support::NumericalError with the time and the reason
  virtual Integrator::StepResult step(double longest_step) = 0;
  virtual double time() const = 0;  ///< end of the last step, or of its part up to a switch
  /// Longest step that passes over nothing that force elements and prescribed motions know to come, from the
  /// state evaluated last [s].
  virtual double calc_longest_step() const = 0;

  /// Brings equations() and energy_flow() to a time within the last step.
  /// @throws support::NumericalError if the joints cannot be closed
  virtual void evaluate(double time, Level level) = 0;
  /// As `evaluate` at the end of the last step, but the integrator's last iterate there is good enough: to
  /// observe the motion, not to continue from it. @param level  kAccelerations or higher
  virtual void evaluate_end_approximately(Level level) { evaluate(time(), level); }
  virtual const ConstrainedEquations& equations() const = 0;  ///< until the next `step` or `resume`
  /// After `evaluate` up to kAccelerations or further.
  virtual Observation observation() {
    const ConstrainedEquations& now = equations();
    return {.equations = now, .q = now.q(), .v = now.v(), .v_dot = now.v_dot()};
  }
  /// Estimated error by vibration of the accelerations evaluated last, in coordinates of equations(), until
  /// the next call of anything else; null where there is no estimate.
  virtual const Eigen::VectorXd* estimate_acceleration_error() { return nullptr; }
  virtual EnergyFlow energy_flow() const = 0;

  virtual SmoothPiece& piece() = 0;
  virtual Statistics statistics() const = 0;
};

}  // namespace sprung::dynamics

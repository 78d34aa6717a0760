#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_monitor.h"
#include "dynamics/integration/stepping_options.h"
#include "dynamics/integration/system_stepper.h"
#include "dynamics/simulation/checkpoint.h"
#include "dynamics/system/energy.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The energy book at one instant [J]: stored energy, and what has been dissipated and put in since the
/// start.
struct EnergyBook {
  Energy stored;
  double dissipated = 0.0;
  double input = 0.0;
};

/// Acceleration of a marker, with accelerations and all markers of the equations up to date [m/s²].
Eigen::Vector2d calc_acceleration(const ConstrainedEquations& equations, std::size_t marker);

/// Something that happened during a run.
struct Event {
  double time = 0.0;
  std::string kind;    ///< "switch", "partition", "modes"
  std::string object;  ///< name of the force element; "" for the whole system
  std::string text;    ///< "touches the ground"
};

/// Everything about the vehicle at one output time; valid during the call that gets it.
struct Snapshot {
  double time = 0.0;
  /// Of the model that is run, in which modes may be held: positions, velocities and forces up to date, all
  /// markers.
  const ConstrainedEquations& equations;
  const Eigen::VectorXd &q, &v, &v_dot;  ///< num_coordinates of the model that the run was given
  std::span<const int> branches;
  EnergyBook energy;
  const ModeAdaptation* modes;  ///< active modes, and the neglect of the others; null without adaptivity
  /// Estimated error of `equations.v_dot()`; null where there is no estimate, and at three of four outputs.
  const Eigen::VectorXd* acceleration_error;

  const SystemTerms& terms() const { return equations.terms(); }
  const Eigen::VectorXd& multipliers() const { return equations.multipliers(); }  ///< num_constraints
  Eigen::Vector2d calc_acceleration(std::size_t marker) const {                   ///< [m/s²]
    return dynamics::calc_acceleration(equations, marker);
  }
  /// Estimated error of it, 0 where there is no estimate [m/s²].
  Eigen::Vector2d calc_acceleration_error(std::size_t marker) const;
};

struct TransientOptions {
  double end_time = 0.0;                                          ///< [s]
  double output_step = 1e-3;                                      ///< > 0 [s]
  double largest_step = std::numeric_limits<double>::infinity();  ///< of the integrator [s]
  SteppingOptions integrator;
  /// Modes that join and leave, or only the indicator of those left out; with `changes`, model and start of
  /// the run are the full ones.
  std::optional<AdaptivityOptions> adaptivity;
  std::function<void(const Snapshot&)> on_output;  ///< at 0, output_step, … to the end
  /// At the ends of some of the steps in which no output was due, with accelerations and all markers up to
  /// date; may be empty.
  std::function<void(double time, const SystemStepper::Observation&, const Energy& stored)> on_time_between;
  std::function<void(const Event&)> on_event;  ///< may be empty
  std::function<bool(double time)> on_step;    ///< after every step; false stops the run; may be empty
  /// Steps and outputs between two checkpoints. Each restarts the integrator (simulation, "Checkpoints").
  long checkpoint_interval = std::numeric_limits<long>::max();
  std::function<void(const Checkpoint&)> on_checkpoint;  ///< may be empty
};

/// Runs a state forward in time. The state has to satisfy the constraints; its branches are chosen here.
/// @throws support::NumericalError with the time at which it could not go on
TransientStatistics run_transient(const Model& model, const State& start, const TransientOptions& options);

/// Continues a run from one of its checkpoints: outputs, events, checkpoints and statistics are those of the
/// run that made it, bit by bit.
/// @param model, options  of that run
/// @throws support::DamagedBytes if the checkpoint is of another model
TransientStatistics resume_transient(const Model& model, const Checkpoint& checkpoint,
                                     const TransientOptions& options);

}  // namespace sprung::dynamics

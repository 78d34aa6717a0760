#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/preparation/prepared_run.h"

namespace sprung::dynamics {

/// A state at t = 0 whose branches are not chosen yet.
State make_state(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

/// Gives a run that continues another the speed of this other run, from which it follows where the vehicle
/// is.
/// @throws support::InputError at `speed` where it is given and differs, or if there is no results file
void take_continued_speed(Run& run);

/// The state in which a run starts: in balance or as given, with speed, initial motion and rates of joints;
/// or the last state of another run. Sets prepared.initial_velocities.
/// @param q         positions of the balance, or as given
/// @param prepared  with the model on its road
/// @throws support::InputError for motion that the joints do not allow, or another run that does not fit
State find_start_state(Eigen::VectorXd q, PreparedRun& prepared);

/// How the run starts beside a model with all modes, for the measure of what its modes leave out. Rates of a
/// run that continues another, or that gives rates of modes, are not compared.
MissingStart find_missing_start(const PreparedRun& prepared, const Model& full);

/// A wheel whose velocity at the start of a run differs from `speed`, because prescribed motion or joints
/// allow no other.
struct WheelSpeed {
  std::string name;    ///< of the force element
  double speed = 0.0;  ///< along the vehicle's direction [m/s]
};
std::vector<WheelSpeed> find_wheels_of_other_speed(const PreparedRun& prepared);

}  // namespace sprung::dynamics

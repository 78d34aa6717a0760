#pragma once

#include <memory>

#include "dynamics/input/run.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/mode_choice/basis_choice.h"

namespace sprung::dynamics {

/// The road by which modes are chosen.
struct RoadOfChoice {
  std::unique_ptr<Road> road;  ///< null: no wave of `[response.road]` lies in the range of frequencies
  double duration = 0.0;       ///< of the drive over it [s]
  bool is_of_response = false;
};
/// That of the run, `[road]`.
RoadOfChoice make_road_of_run(const Run& run);
/// 40 s of a random road with the spectrum of `[response.road]`, of waves in the range of frequencies.
/// @param run  with `[response.road]` and a speed > 0
RoadOfChoice make_road_of_response(const Run& run);

/// Chooses the modes of the bodies with modes "auto" from the road and the forces given in time. The vehicle
/// with all modes of these bodies is linearised about static equilibrium. All modes are kept, with the reason
/// among the remarks, where the forcing is not known beforehand: an unstable equilibrium, or a run with
/// prescribed motion, `[initial]`, a start other than in static equilibrium, or backwards.
/// @param all      the selection with all modes of these bodies
/// @param damping  of that selection
/// @throws support::InputError, support::NumericalError as prepare_run
/// Checked by tests/verification/select_test.py and response_limits_test.py
BasisChoice choose_automatic_modes(const Run& run, const Vehicle& vehicle, const ModeSelection& all,
                                   const ModalDamping& damping, const StiffenedBodies& stiffened,
                                   const RoadOfChoice& road);

/// A selection without the modes that the choice leaves out, and without bodies that have no mode left.
ModeSelection keep_modes(const BasisChoice& choice, ModeSelection all);

}  // namespace sprung::dynamics

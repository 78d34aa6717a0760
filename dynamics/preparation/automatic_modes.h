#pragma once

#include "dynamics/input/run.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/mode_choice/basis_choice.h"

namespace sprung::dynamics {

/// Chooses the modes of the bodies with modes "auto" from the road and the forces given in time. The vehicle
/// with all modes of these bodies is linearised about static equilibrium. All modes are kept, with the reason
/// among the remarks, where the forcing is not known beforehand: prescribed motion, `[initial]`, a start
/// other than in static equilibrium, an unstable equilibrium, driving backwards.
/// @param all      the selection with all modes of these bodies
/// @param damping  of that selection
/// @throws support::InputError, support::NumericalError as prepare_run
/// Checked by tests/verification/select_test.py
BasisChoice choose_automatic_modes(const Run& run, const Vehicle& vehicle, const ModeSelection& all,
                                   const ModalDamping& damping, const StiffenedBodies& stiffened,
                                   const Road& road);

/// A selection without the modes that the choice leaves out, and without bodies that have no mode left.
ModeSelection keep_modes(const BasisChoice& choice, ModeSelection all);

}  // namespace sprung::dynamics

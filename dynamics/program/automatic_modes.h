#pragma once

#include "dynamics/input/run.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/mode_choice/basis_choice.h"

namespace sprung::dynamics {

/// Chooses the modes of the bodies that a run leaves to the program, by the run's road and the forces given
/// in time on the vehicle with all their modes, linearised about static balance. Where that says nothing of
/// the forcing all modes are kept, with the reason among the remarks: prescribed motion, `[initial]`, a start
/// other than in static balance, an unstable balance, driving backwards.
/// @param all  the selection with all modes of these bodies  @param damping  of that selection
/// @throws support::InputError, support::NumericalError as making the run ready
BasisChoice choose_automatic_modes(const Run& run, const Vehicle& vehicle, const ModeSelection& all,
                                   const ModalDamping& damping, const StiffenedBodies& stiffened,
                                   const Road& road);

/// A selection without the modes that the choice leaves out; bodies without any are left out.
ModeSelection keep_modes(const BasisChoice& choice, ModeSelection all);

}  // namespace sprung::dynamics

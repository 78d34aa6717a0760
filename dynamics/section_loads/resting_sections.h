#pragma once

#include "dynamics/linear/equilibrium.h"
#include "dynamics/section_loads/section_statistics.h"

namespace sprung::dynamics {

/// The forces and moments along the beams at an equilibrium.
/// @param sections  of the model, brought up to date; has to outlive the result
/// @throws support::NumericalError if the equations have no solution there
SectionStatistics calc_resting_sections(const Model& model, const Equilibrium& equilibrium,
                                        VehicleSections& sections);

}  // namespace sprung::dynamics

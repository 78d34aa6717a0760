#pragma once

#include "dynamics/linear/equilibrium.h"
#include "dynamics/section_loads/body_bending.h"
#include "dynamics/section_loads/section_statistics.h"

namespace sprung::dynamics {

/// The forces and moments along the beams of flexible bodies, and their bending.
struct RestingSections {
  SectionStatistics loads;
  std::vector<BodyBending> bending;
};

/// Those at an equilibrium.
/// @param sections  of the model, brought up to date; has to outlive the result
/// @throws support::NumericalError if the equations have no solution there
RestingSections calc_resting_sections(const Vehicle& vehicle, const Model& model,
                                      const Equilibrium& equilibrium, VehicleSections& sections);

}  // namespace sprung::dynamics

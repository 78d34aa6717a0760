#pragma once

#include "dynamics/input/vehicle.h"
#include "dynamics/response/linear_outputs.h"

namespace sprung::dynamics {

/// Bending moments of all bodies with active modes as outputs of the linear vehicle, from the loads where
/// sections have these (section_loads, eq. 2), else from the modes. They are at the places where the
/// moments of the modes are the largest, one place for each mode. `by_load` is part of them.
/// Checked by tests/verification/select_test.py
LinearOutputs make_moment_outputs(const LinearVehicle& linear, const Vehicle& vehicle);

}  // namespace sprung::dynamics

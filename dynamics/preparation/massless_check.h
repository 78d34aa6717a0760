#pragma once

#include <Eigen/Core>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// @param q  assembled positions
/// @throws support::InputError at a body without mass or inertia that can move without moving any mass
/// Checked by tests/verification/massless_test.py
void check_massless_bodies(const Vehicle& vehicle, const Model& model, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

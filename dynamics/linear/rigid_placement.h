#pragma once

#include <Eigen/Core>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// Shifts vehicles along x and y to where prescribed motions of points begin, so that neither their joints
/// nor their springs feel it. A vehicle is all bodies that joints and force elements connect. It is shifted
/// where this alone brings its driven points to their values, where no force element ties it to the ground,
/// and no joint with the ground opens; with tyres, along x alone.
/// @param[in,out] q  nq
/// @return the largest shift [m]
/// Checked by tests/dynamics/program/assembly_warnings_test.py
double place_driven_vehicles(const Model& model, Eigen::VectorXd& q);

}  // namespace sprung::dynamics

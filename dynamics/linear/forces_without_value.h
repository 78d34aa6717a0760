#pragma once

#include <string>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// Names the force elements whose force is no number, as that of an air spring is whose bellows have no
/// volume left, and how far apart their points are; empty if there are none.
/// @param q  nq, where the model is at rest
std::string describe_forces_without_value(const Model& model, double time, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

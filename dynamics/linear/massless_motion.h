#pragma once

#include <Eigen/Core>
#include <optional>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A motion that the joints allow and that no mass takes part in, so that a force would accelerate it without
/// limit (linear, eq. 11).
/// @param q  assembled positions, num_coordinates
/// @return the coordinate of a body without mass or inertia that takes the largest part in it; none where
///         there is no such motion, or too many freedoms to look for it
/// Checked by tests/dynamics/linear/massless_motion_test.cpp
std::optional<int> find_massless_motion(const Model& model, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

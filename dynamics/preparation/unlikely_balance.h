#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// Remarks on a static equilibrium that hardly any vehicle has: springs that point the other way than as
/// drawn, suspensions on their stops, bodies of a vehicle on tyres that are turned or moved far or hang on a
/// spring, tyres that are pressed in deeply, and on wheels that are drawn under the road.
/// @param drawn, found  positions before and in equilibrium, num_coordinates
/// @throws support::InputError at a tyre that is pressed in by more than its radius
/// Checked by tests/dynamics/program/unlikely_balance_test.py
std::vector<std::string> list_unlikely_balance(const Vehicle& vehicle, const Model& model,
                                               const Eigen::VectorXd& drawn, const Eigen::VectorXd& found);

/// Names the bodies on which no joint and no force element acts; "" if there are none.
std::string describe_idle_bodies(const Model& model);

/// Names the force element that is drawn far longer than the vehicle's bodies are large; "" if there is none.
std::string describe_far_element(const Vehicle& vehicle, const Model& model, const Eigen::VectorXd& drawn);

/// A remark on the deepest of the wheels that are drawn under the road; "" if there is none.
/// @param drawn  num_coordinates
std::string remark_on_wheel_under_road(const Vehicle& vehicle, const Model& model,
                                       const Eigen::VectorXd& drawn);

/// Refuses a vehicle of which no equilibrium was found where its wheels are drawn under the road.
/// @param drawn  num_coordinates
/// @throws support::InputError at the deepest of the tyres whose wheel centre is below level ground
void reject_wheels_under_road(const Vehicle& vehicle, const Model& model, const Eigen::VectorXd& drawn);

}  // namespace sprung::dynamics

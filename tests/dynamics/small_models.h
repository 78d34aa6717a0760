#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/forces/spring_damper.h"
#include "dynamics/system/model.h"

namespace sprung::test {

/// Parts of models written down in a test. All return the index of what they add; number_model comes last.

int add_body(dynamics::Model& model, dynamics::Body body);
/// A point fixed to a body's frame, or to the ground. @param p  body axes [m]
int add_marker(dynamics::Model& model, int body, const Eigen::Vector2d& p, const std::string& name = "point");
/// A point rigidly offset from a node of a flexible body with the body's active modes. @param offset  body
/// axes [m]
int add_node_marker(dynamics::Model& model, int body, const reduce::Superelement& superelement, int node,
                    const Eigen::Vector2d& offset = Eigen::Vector2d::Zero());
void add_pin(dynamics::Model& model, const std::string& name, int marker_a, int marker_b);
/// Of stiffness k [N/m] and damping coefficient c [N·s/m].
void add_spring(dynamics::Model& model, const std::string& name, int marker_a, int marker_b,
                double free_length, double k, double c);

/// A uniform bar pinned at the origin, its centre `arm` away along its own x, of the inertia that makes it
/// swing like a point at `length`: arm < length. Markers: "pivot" on the bar, "ground.pivot", "bob" at
/// `length`.
dynamics::Model make_pendulum(double mass, double arm, double length, double gravity);
/// Its coordinates at an angle from the x axis.
Eigen::Vector3d place_pendulum(double arm, double angle);

/// A state at q and v with branches not chosen yet.
dynamics::State make_state(const dynamics::Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

}  // namespace sprung::test

#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/bodies/body.h"
#include "dynamics/bodies/marker.h"
#include "dynamics/forces/force_element.h"
#include "dynamics/functions/detail_lengths.h"
#include "dynamics/joints/joint.h"
#include "dynamics/system/fading_force.h"

namespace sprung::dynamics {

/// A coordinate of the system as one of a body.
struct BodyCoordinate {
  int body = 0;   ///< position in Model::bodies; -1 for an internal state of a force element
  int local = 0;  ///< 0: x, 1: y, 2: angle, 3 + k: the body's k-th active mode; -1 for a state

  bool is_modal() const { return local >= 3; }
  bool is_state() const { return body < 0; }
};

/// A multibody system as the solver sees it: immutable once made. Changing the active modes of a body makes
/// another model with the same joints and forces, as `hold_modes` does.
struct Model {
  std::vector<Body> bodies;
  std::vector<Marker> markers;
  // Shared with models that differ in their active modes.
  std::vector<std::shared_ptr<const Joint>> joints;
  std::vector<std::shared_ptr<const ForceElement>> forces;
  Eigen::Vector2d gravity = Eigen::Vector2d::Zero();  ///< [m/s²]

  int num_coordinates = 0;
  int num_constraints = 0;
  std::vector<int> joint_rows;      ///< first constraint of each joint
  std::vector<int> force_branches;  ///< first branch of each force element
  int num_branches = 0;
  std::vector<InternalState> states;  ///< of all force elements: the last coordinates (system, eq. 14)
  std::vector<int> force_states;      ///< first of `states` of each force element; last, the number of all
  std::vector<int> acting_markers;    ///< those of joints and forces, ascending; the others are for results
  double length_scale = 1.0;          ///< the model's size, for tolerances [m]
  bool has_moving_joints = false;     ///< some joint depends on time
  bool has_massless_bodies = false;   ///< some body has no mass or no inertia
  bool has_light_bodies = false;      ///< some mass or inertia is 0 or below the least metric
  std::vector<double> time_breaks;    ///< where functions of time have a kink or jump, ascending [s]
  DetailLengths time_details;         ///< of all functions of time

  int num_states() const { return static_cast<int>(states.size()); }
  int first_state() const { return num_coordinates - num_states(); }  ///< coordinate of the first state
  /// Independent coordinates, those of internal states included.
  int num_freedoms() const { return num_coordinates - num_constraints; }
  bool has_modes() const;  ///< of any body
  /// The freedoms of the motion, without the internal states.
  int num_mechanical_freedoms() const { return first_state() - num_constraints; }
  /// The part of all velocities, or forces, that belongs to the states of force element f.
  template <class Value>
  std::span<Value> states_of(std::size_t f, Value* v) const {
    if (states.empty()) return {};
    return {v + first_state() + force_states[f],
            static_cast<std::size_t>(force_states[f + 1] - force_states[f])};
  }
  /// The part of all branches that belongs to force element f.
  template <class Branches>
  auto branches_of(std::size_t f, Branches& branches) const {
    return std::span(branches).subspan(static_cast<std::size_t>(force_branches[f]),
                                       static_cast<std::size_t>(forces[f]->num_branches()));
  }
  BodyCoordinate body_coordinate(int coordinate) const;
  /// "chassis.x", "chassis.angle", "chassis.mode 3"; of an internal state "mount.relaxation_x"
  std::string coordinate_name(int coordinate) const;
  /// Natural size of a coordinate: length_scale for positions, 1 for angles, for a modal coordinate the value
  /// that moves some node by length_scale.
  double coordinate_scale(int coordinate) const;
  /// The largest absolute entry over the natural size of its coordinate. @param values  num_coordinates
  double largest_natural(const Eigen::VectorXd& values) const;
  /// Residual of joints that are closed as well as the rounding of coordinates allows: it counts where bodies
  /// are far from the origin, or have turned many times [m, rad].
  /// @param q  num_coordinates
  double calc_rounding(const Eigen::VectorXd& q) const;
  int find_body(const std::string& name) const;    ///< -1 if there is none
  int find_marker(const std::string& name) const;  ///< -1 if there is none
};

/// K x of the bodies' modes, or |K| x. @param x  num_coordinates × k   @return the same
Eigen::MatrixXd apply_modal_stiffness(const Model& model, const Eigen::MatrixXd& x, bool of_sizes = false);

/// Numbers coordinates, constraints, branches and internal states, and measures the model. Call once bodies,
/// markers, joints and forces are complete.
void number_model(Model& model);

/// Positions and velocities of the whole system, with the branches of its force elements and the forces that
/// the run itself puts on its modes.
struct State {
  double time = 0.0;                     ///< [s]
  Eigen::VectorXd q;                     ///< num_coordinates
  Eigen::VectorXd v;                     ///< num_coordinates
  std::vector<int> branches;             ///< num_branches
  std::vector<FadingForce> fading = {};  ///< on modes that have joined lately
};

}  // namespace sprung::dynamics

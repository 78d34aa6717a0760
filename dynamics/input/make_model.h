#pragma once

#include <Eigen/Core>
#include <span>

#include "dynamics/input/mode_selection.h"
#include "dynamics/input/stiffening_input.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/road/road.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The multibody model of a vehicle with these modes active, on a road. Bodies, joints and forces are in the
/// order of the file, prescribed motions are joints after the others, and markers are in the order of
/// `list_points`, for any selection of modes.
/// @param road       must outlive the model
/// @param damping    ratios ζ that replace the superelement's damping by diag(2 ζ ω m)
/// @param motions    whether prescribed motion varies, or keeps its value at t = 0
/// @param stiffened  bodies that axial forces stiffen
/// @throws std::invalid_argument for modes that a superelement, or its geometric stiffness, lacks (never with
///         selections from `resolve_modes` and `resolve_stiffening`)
/// Checked by tests/dynamics/input/make_model_test.cpp
Model make_model(const Vehicle& vehicle, const ModeSelection& selection, const PlacedRoad& road,
                 const ModalDamping& damping = {}, MotionUse motions = MotionUse::kMoving,
                 const StiffenedBodies& stiffened = {});

/// Positions as given in the vehicle file, all bodies undeformed.
/// @return q, model.num_coordinates
Eigen::VectorXd make_start_positions(const Model& model, const Vehicle& vehicle);

/// Position of the vehicle's front along its heading: direction · x of the foremost wheel's centre, or of the
/// foremost body frame if there are no tyres [m].
/// @param markers  in the order of model.markers, positions up to date
double find_leading_position(const Model& model, const Vehicle& vehicle,
                             std::span<const MarkerState> markers);

}  // namespace sprung::dynamics

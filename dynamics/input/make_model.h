#pragma once

#include <Eigen/Core>
#include <span>

#include "dynamics/input/mode_selection.h"
#include "dynamics/input/stiffening_input.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/road/road.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The multibody system that a vehicle is with these modes active and on this road. Bodies, joints and forces
/// stand in the order of the file, prescribed motions as joints behind the others, markers in that of
/// `list_points`, whatever the selection.
/// @param road     must outlive the model
/// @param damping  ratios ζ that replace the superelement's damping by diag(2 ζ ω m)
/// @param motions  whether prescribed motion goes on, or stands still as at t = 0
/// @param stiffened  bodies that their axial forces stiffen
/// @throws std::invalid_argument for modes that a superelement, or its geometric stiffness, lacks;
///         `resolve_modes` and `resolve_stiffening` give none
Model make_model(const Vehicle& vehicle, const ModeSelection& selection, const PlacedRoad& road,
                 const ModalDamping& damping = {}, MotionUse motions = MotionUse::kMoving,
                 const StiffenedBodies& stiffened = {});

/// Positions as the vehicle file gives them, all modes undeformed.
/// @return q, model.num_coordinates
Eigen::VectorXd make_start_positions(const Model& model, const Vehicle& vehicle);

/// Where the vehicle's front is along its heading: direction · x of the foremost wheel's centre; of the
/// foremost body frame where there are no tyres [m].
/// @param markers  positions up to date, in the order of model.markers
double find_leading_position(const Model& model, const Vehicle& vehicle,
                             std::span<const MarkerState> markers);

}  // namespace sprung::dynamics

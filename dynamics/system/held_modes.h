#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A model in which some modal coordinates of another stand still at a value of their own: their bodies keep
/// that deformation, with the inertia that belongs to it, and have the remaining modes (system, eq. 12).
struct HeldModes {
  Model model;                   ///< same markers, joints, forces and constraints
  std::vector<int> coordinates;  ///< of `model`: their place in the other model's, ascending
};

/// @param full       has no held modes itself
/// @param is_active  for each coordinate of `full`; all but modal ones are active whatever it says
/// @param q          coordinates of `full`; what is held keeps its value there
/// @throws std::invalid_argument where held and active modes of a body are coupled by stiffness: that would
/// be a force
HeldModes hold_modes(const Model& full, const std::vector<bool>& is_active, const Eigen::VectorXd& q);

/// The places of a model's coordinates in a fuller model of the same vehicle, which has more modes.
/// @return without a model
/// @throws std::invalid_argument for a mode that `full` does not have
HeldModes match_modes(const Model& model, const Model& full);

/// Values of the active coordinates.
Eigen::VectorXd select_active(const HeldModes& held, const Eigen::VectorXd& full);
/// Puts the values of the active coordinates in their places; the others stay.
void put_active(const HeldModes& held, const Eigen::VectorXd& active, Eigen::VectorXd& full);

}  // namespace sprung::dynamics

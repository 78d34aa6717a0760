#pragma once

#include <Eigen/Core>
#include <optional>

#include "dynamics/linear/modal_force.h"
#include "dynamics/linear/steady_motion.h"
#include "dynamics/system/partitioned_equations.h"

namespace sprung::dynamics {

/// A position from which Newton steps are taken, although at first neither potential energy nor forces
/// decrease.
struct Watch {
  Eigen::VectorXd q;  ///< nq
  double potential, force;
  double reach;  ///< how far from there the steps may lead [natural sizes]
  int steps_left;
};

/// The search for an equilibrium. The bounds of a step widen each time the forces change as the stiffness
/// predicts.
struct Search {
  double damping = 0.0;  ///< added to the stiffness of each direction
  double reach = kLargestStep;
  std::optional<Watch> watch;
  int wait = 0, next_wait = 1;  ///< steps downhill until the next watch, and after its failure
};

/// One step from the positions where `system` stands: downhill, so that the potential energy decreases or the
/// forces do, or a whole Newton step under watch. A beam that bends is a narrow curved valley, whose walls
/// are its axial stiffness: a step along the valley runs up the wall, and the next Newton step comes down to
/// its floor, far beyond any step that only descends.
/// @param q  nq   @return nq
Eigen::VectorXd take_step(const Model& model, PartitionedEquations& equations, const LinearisedSystem& system,
                          const ModalForce& modal, const Eigen::VectorXd& q, const SteadyMotion& motion,
                          Search& search);

/// Further steps after a Newton step, with the same stiffness, as long as they decrease fast. Each costs one
/// evaluation; a new stiffness costs four for each freedom.
/// @param last_size       of the Newton step [natural sizes]
/// @param tolerance       of a step, at which they end
/// @param[in,out] steps   number of steps taken
/// @return positions, nq
Eigen::VectorXd iterate_with_same_stiffness(const Model& model, PartitionedEquations& equations,
                                            const LinearisedSystem& system, const ModalForce& modal,
                                            const SteadyMotion& motion, double last_size, double tolerance,
                                            int& steps);

}  // namespace sprung::dynamics

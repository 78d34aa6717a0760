#pragma once

#include <string>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// How far from the drawing a prescribed motion begins.
struct MotionGap {
  std::string motion, unit;   ///< its name; "m" or "rad"
  double above = 0.0;         ///< the coordinate as drawn, less the value of the motion at the start
  double natural_size = 0.0;  ///< |above|, over the length scale or 1 rad
};

/// How the constraints were satisfied at the start.
struct AssemblyReport {
  double shift = 0.0;             ///< of a whole vehicle, first, to where its prescribed motion begins [m]
  double largest_movement = 0.0;  ///< of any marker [m]
  std::string moved_marker;       ///< which one
  double residual = 0.0;          ///< largest |φ| afterwards
  double widest_gap = 0.0;        ///< of a joint before, a distance [m]
  std::string open_joint;         ///< which joint
  MotionGap motion_gap;           ///< the largest one, in natural sizes

  std::string describe_shift() const;  ///< a line of text; empty for none
};

/// Moves the bodies from the positions of the input file so that every joint closes: whole vehicles to where
/// prescribed motions begin (rigid_placement), then with the least movement in the mass metric: heavy bodies
/// move least, and bodies deform only where they cannot close the joints as rigid ones (Gauss–Newton).
/// @param[in,out] q  num_coordinates
/// @throws support::InputError at the joint, if the joints cannot be closed from the given positions, or if
///         some of them are redundant (the message names all that take part)
/// Checked by tests/dynamics/linear/assembly_test.cpp
AssemblyReport assemble_positions(const Model& model, Eigen::VectorXd& q);

/// The largest change of the given velocities by project_velocities.
struct VelocityReport {
  double largest_change = 0.0;  ///< [natural sizes/s]
  std::string coordinate;       ///< the coordinate that has it
};

/// How the rates of modes change where velocities do not satisfy the constraints.
enum class ModalRates {
  kByMass,      ///< as much as those of bodies: as in an impact
  kIfNecessary  ///< only where bodies cannot follow as rigid ones
};

/// Replaces v by the nearest velocity, in the mass metric, that satisfies the constraints. Prescribed motion
/// is followed.
/// @param q          assembled positions, num_coordinates
/// @param[in,out] v  num_coordinates
/// @throws support::NumericalError at a singular position
/// Checked by tests/dynamics/linear/assembly_test.cpp
VelocityReport project_velocities(const Model& model, double time, const Eigen::VectorXd& q,
                                  Eigen::VectorXd& v, ModalRates modal_rates = ModalRates::kByMass);

}  // namespace sprung::dynamics

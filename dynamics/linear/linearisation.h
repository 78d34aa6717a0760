#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/linear/steady_motion.h"
#include "dynamics/system/partitioned_equations.h"

namespace sprung::dynamics {

/// The vehicle linearised about a state, in its independent coordinates:
/// M̂ δq̈ + Ĉ δq̇ + K̂ δq = 0, f freedoms (linear, eq. 1).
struct LinearisedSystem {
  Partition partition;
  Eigen::MatrixXd mass, damping, stiffness;  ///< f×f
  Eigen::MatrixXd stiffness_rounding;        ///< f×f, ≥ 0: R (linear, eq. 7)
  Eigen::MatrixXd directions;                ///< nq×f, ∂q/∂q_i
  Eigen::VectorXd force;                     ///< f, residual: 0 at an equilibrium
  Eigen::VectorXd force_rounding;            ///< f, ≥ 0: r (linear, eq. 9)
};

/// Linearises the vehicle about rest, or about steady motion in the coordinates relative to it
/// (linear, eqs. 1, 2, 5, 6). Stiffness and damping come from central differences, in which a kink beside
/// rest does not count, and one at rest counts with the mean of its two slopes; those of the stiffness are
/// extrapolated to fourth order. The stiffness of the bodies' modes is added without a difference, so that
/// stiff modes cause no rounding error.
/// @param q            assembled positions
/// @param[out] spread  f×f, ≥ 0: how far the slopes of the stiffness lie apart (linear, eq. 12); may be null
/// @throws support::NumericalError if the constraints cannot be satisfied around q, or if a force has no
///         value there (the message names the force element)
/// Checked by tests/dynamics/linear/vehicle_modes_test.cpp, tests/verification/steady_test.py
LinearisedSystem linearise(PartitionedEquations& equations, double time, const Eigen::VectorXd& q,
                           const SteadyMotion& motion = {}, Eigen::MatrixXd* spread = nullptr);

/// The damping Ĉ alone, at the positions that the equations were last evaluated at: f×f. They are left at
/// other velocities.
Eigen::MatrixXd calc_reduced_damping(PartitionedEquations& equations, const SteadyMotion& motion = {});

/// Reduced force DᵀQ at rest. With steady motion, M̂ ρ̈_i of a system at rest relative to it.
/// @param q_independent   f
/// @param[out] potential  potential energy [J], less the kinetic energy of the steady motion; may be null
/// @return f; empty if the dependent coordinates cannot be found for q_independent
Eigen::VectorXd calc_static_force(PartitionedEquations& equations, double time,
                                  const Eigen::VectorXd& q_independent, double* potential = nullptr,
                                  const SteadyMotion& motion = {});

}  // namespace sprung::dynamics

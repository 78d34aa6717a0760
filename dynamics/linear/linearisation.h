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
  Eigen::MatrixXd stiffness_rounding;        ///< f×f, ≥ 0: R (linear, eq. 14)
  Eigen::MatrixXd directions;                ///< nq×f, ∂q/∂q_i
  Eigen::VectorXd force;                     ///< f, what is left of the forces: 0 at an equilibrium
  Eigen::VectorXd force_rounding;            ///< f, ≥ 0: r (linear, eq. 16)
};

/// Stiffness from differences of the reduced force, central and extrapolated to fourth order, so that a kink
/// counts with the mean of its two slopes; that of the bodies' modes is added as it is, so that stiff modes
/// leave no rounding of differences. Damping likewise about rest. About steady motion, that of the
/// coordinates which are carried along (linear, eqs. 4, 5).
/// @param q  assembled positions; the branches are chosen at each of the points compared
/// @throws support::NumericalError if the constraints cannot be satisfied around q
LinearisedSystem linearise(PartitionedEquations& equations, double time, const Eigen::VectorXd& q,
                           const SteadyMotion& motion = {});

/// Reduced force at rest; about steady motion on who stands still in it: M̂ ρ̈_i.
/// @param[out] potential  potential energy there [J], less the kinetic energy of steady motion, if not null
/// @return f; empty if the dependents cannot be found for q_independent
Eigen::VectorXd calc_static_force(PartitionedEquations& equations, double time,
                                  const Eigen::VectorXd& q_independent, double* potential = nullptr,
                                  const SteadyMotion& motion = {});

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <optional>

#include "dynamics/system/partitioned_equations.h"

namespace sprung::dynamics {

/// Steady motion of a whole system: one rigid motion of the plane carries all bodies along, with
/// Ṙ = velocity + omega S R and θ̇ = omega. Coordinates ρ that are carried along stand still in it:
///
///     q̇ = w(q) + ρ̇,   q̈ = ρ̈ + omega S (2ρ̇ + w)  (of R alone)                  (linear, eq. 4)
///
/// Rest is the steady motion that is zero.
struct SteadyMotion {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< of what passes the world's origin [m/s]
  double omega = 0.0;                                  ///< [rad/s]

  bool is_rest() const { return omega == 0.0 && velocity.isZero(0.0); }
  /// w(q), nq.
  Eigen::VectorXd calc_velocity(const Model& model, const Eigen::VectorXd& q) const;
  /// q̈ − ρ̈, nq. @param v  velocities, w + ρ̇
  Eigen::VectorXd calc_acceleration(const Model& model, const Eigen::VectorXd& q,
                                    const Eigen::VectorXd& v) const;
  /// The positions that q is carried to in a time, nq.
  Eigen::VectorXd carry(const Model& model, Eigen::VectorXd q, double time) const;
  /// Accelerations or velocities as seen by who is carried, back at time 0, nq.
  Eigen::VectorXd turn_back(const Model& model, Eigen::VectorXd vectors, double time) const;
};

/// The steady motion that prescribed motion has at t = 0: the rigid motion that all constraints allow.
/// @param q  assembled  @return none where there is none, as in a mechanism that stands while its crank turns
std::optional<SteadyMotion> find_steady_motion(const Model& model, const Eigen::VectorXd& q);

/// Whether the equations are the same for who is carried along at any time: compares the accelerations around
/// q at t = 0 with those where the motion has carried it. Not so with weight on what turns, a road under it,
/// springs to the ground, or prescribed motion that changes its rate.
bool is_steady(const Model& model, const SteadyMotion& motion, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

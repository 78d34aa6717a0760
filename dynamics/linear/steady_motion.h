#pragma once

#include <Eigen/Core>
#include <optional>

#include "dynamics/system/partitioned_equations.h"

namespace sprung::dynamics {

/// Steady motion of a whole system: all bodies follow one rigid motion of the plane at constant rates,
/// Ṙ = velocity + omega S R and θ̇ = omega. The coordinates ρ relative to this motion satisfy
///
///     q̇ = w(q) + ρ̇,   q̈ = ρ̈ + omega S (2ρ̇ + w)  (of R alone)                  (linear, eq. 5)
///
/// Rest is the steady motion that is zero.
struct SteadyMotion {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< of a body at the world's origin [m/s]
  double omega = 0.0;                                  ///< [rad/s]

  bool is_rest() const { return omega == 0.0 && velocity.isZero(0.0); }
  /// w(q), nq.
  Eigen::VectorXd calc_velocity(const Model& model, const Eigen::VectorXd& q) const;
  /// q̈ − ρ̈, nq. @param v  velocities, w + ρ̇
  Eigen::VectorXd calc_acceleration(const Model& model, const Eigen::VectorXd& q,
                                    const Eigen::VectorXd& v) const;
  /// The positions after a time of bodies that follow the motion from q, nq.
  Eigen::VectorXd move_positions(const Model& model, Eigen::VectorXd q, double time) const;
  /// Velocities or accelerations at a time, rotated back by the angle that the motion has turned through, nq.
  Eigen::VectorXd rotate_back(const Model& model, Eigen::VectorXd vectors, double time) const;
};

/// The steady motion that agrees with all constraints and the prescribed rates at t = 0.
/// @param q  assembled positions, nq
/// @return none if there is no such motion, as in a mechanism whose crank turns while its frame stands
/// Checked by tests/verification/steady_test.py
std::optional<SteadyMotion> find_steady_motion(const Model& model, const Eigen::VectorXd& q);

/// Whether the equations relative to the motion are the same at all times: compares the accelerations near q
/// at t = 0 with those at later positions of the motion. They differ with weight on a rotating system, a road
/// under it, springs to the ground, or prescribed motion whose rate changes.
/// Checked by tests/verification/steady_test.py
bool is_steady(const Model& model, const SteadyMotion& motion, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

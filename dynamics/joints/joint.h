#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/bodies/marker.h"
#include "dynamics/description/element_description.h"
#include "dynamics/functions/time_function.h"
#include "dynamics/joints/relative_coordinate.h"
#include "tools/support/errors/input_error.h"

namespace sprung::dynamics {

/// Most constraint equations one joint may have.
inline constexpr int kMaxJointConstraints = 3;

/// k×3 Jacobian of a joint's constraints with respect to the motion (δx, δy, δangle) of one of its markers.
using JointJacobian = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMaxJointConstraints, 3>;
/// k values, one for each constraint.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJointConstraints, 1>;

/// A constraint between two markers: φ(a, b, t) = 0 with k equations. A joint sees markers alone, never
/// coordinates. So any mix of rigid bodies, flexible bodies and ground can be joined, and the solver does not
/// depend on the kinds of joints.
class Joint {
 public:
  Joint(std::string joint_name, int marker_of_a, int marker_of_b, support::SourceLocation where)
      : name(std::move(joint_name)),
        marker_a(marker_of_a),
        marker_b(marker_of_b),
        location(std::move(where)) {}
  virtual ~Joint() = default;

  virtual std::string_view kind() const = 0;
  /// Its points in the order a, b, and its parameters.
  virtual ElementDescription describe() const = 0;
  /// Whether it is an entry of `[[motions]]`: its one constraint drives its coordinate, and results hold the
  /// force or torque that this takes.
  virtual bool is_motion() const { return false; }
  /// The coordinate that results show and whose initial rate may be given; none for a joint without one.
  virtual std::optional<RelativeCoordinate> coordinate() const { return std::nullopt; }

  /// Whether its reaction at a can contain a torque.
  virtual bool carries_torque() const = 0;
  /// Whether its reaction at b can contain a torque. A force along an axis of a acts at b, so it turns a and
  /// not b.
  virtual bool carries_torque_at_b() const = 0;

  virtual int num_constraints() const = 0;
  /// The quantity that constraint k (0-based) holds, for messages: "x", "y".
  virtual std::string_view constraint_name(int k) const = 0;
  /// Whether constraint k is on an angle [rad], and not on a length [m].
  virtual bool is_angle(int k) const = 0;
  std::string_view constraint_unit(int k) const { return is_angle(k) ? "rad" : "m"; }

  /// @param[out] phi  k residuals [m, rad]
  virtual void calc_residual(const MarkerState& a, const MarkerState& b, double time,
                             JointVector& phi) const = 0;

  /// @param[out] Ga, Gb  ∂φ/∂(motion of a), ∂φ/∂(motion of b), k×3; φ̇ = Ga (v_a, ω_a) + Gb (v_b, ω_b) + φ_t
  virtual void calc_jacobian(const MarkerState& a, const MarkerState& b, JointJacobian& Ga,
                             JointJacobian& Gb) const = 0;
  /// Whether Ga and Gb are the same at all positions. They are then computed once, and their zero entries are
  /// left out of the elimination.
  virtual bool has_constant_jacobian() const { return false; }

  /// @param[out] phi_t  k partial time derivatives of φ [m/s, rad/s]; zero unless φ depends on time
  virtual void calc_time_rate(const MarkerState& a, const MarkerState& b, double time,
                              JointVector& phi_t) const;

  /// @param[out] drift  k terms of φ̈ that do not contain accelerations of the markers:
  ///                    Ġa (v_a, ω_a) + Ġb (v_b, ω_b) + explicit time terms [m/s², rad/s²]
  virtual void calc_drift(const MarkerState& a, const MarkerState& b, double time,
                          JointVector& drift) const = 0;

  /// Its functions of time; the integrator ends a step at each of their breaks.
  virtual std::vector<const TimeFunction*> time_functions() const { return {}; }
  /// Largest integration step for which the prescribed motion can be followed [s].
  /// @param length_scale  of the model [m]
  virtual double calc_longest_step(double /*time*/, double /*length_scale*/) const {
    return std::numeric_limits<double>::infinity();
  }

  const std::string name;
  const int marker_a;
  const int marker_b;
  const support::SourceLocation location;  ///< where the vehicle file has it
};

}  // namespace sprung::dynamics

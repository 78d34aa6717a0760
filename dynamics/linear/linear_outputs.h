#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/linear/linear_vehicle.h"

namespace sprung::dynamics {

/// What an output is, for those that pick among them.
struct OutputSubject {
  enum class Kind { kPoint, kModeShare, kMode, kChannel, kReaction };
  enum class Derivative { kDisplacement, kVelocity, kAcceleration };
  Kind kind = Kind::kPoint;
  int object = 0;  ///< marker, for kMode the body; for kChannel the force element, for kReaction the joint
  Derivative derivative = Derivative::kDisplacement;  ///< of motion
  int component = 0;                                  ///< 0: x, 1: y, 2: angle or torque; of kMode the mode
  ChannelRole role = ChannelRole::kForce;             ///< of a channel
};

/// p quantities read off from a linear vehicle, named as in a results file: of the motion x of its f
/// independent coordinates and what the road does at nq coordinates and directly (linear, eq. 10).
struct LinearOutputs {
  std::vector<std::string> names;  ///< "points/chassis.seat/acceleration.y"
  std::vector<std::string> units;
  std::vector<OutputSubject> subjects;
  Eigen::MatrixXd by_position, by_velocity, by_acceleration;  ///< p×f
  Eigen::MatrixXd by_force;                                   ///< p×nq, of the road's generalized forces
  std::vector<int> channels;  ///< p, the channel (of all) whose direct part is added; −1: none

  int size() const { return static_cast<int>(names.size()); }
  void append(const LinearOutputs& other);
  LinearOutputs pick(const std::vector<int>& rows) const;
};

/// Displacement, velocity and acceleration of a marker: x, y and angle of each, world axes, 9 outputs.
LinearOutputs make_point_outputs(const LinearVehicle& vehicle, int marker);

/// Displacement and acceleration of a marker as far as each of its body's modes carries it, x, y and angle, 6
/// for each mode: what the mode's part in the point's motion is. With the rigid motion of the body frame they
/// add up to the marker's own.
LinearOutputs make_mode_share_outputs(const LinearVehicle& vehicle, int marker);

/// Amplitude and acceleration of every mode of every body.
LinearOutputs make_modal_outputs(const LinearVehicle& vehicle);

/// Channels of all force elements; those that only say which formula is in use or where the road is are left
/// out.
LinearOutputs make_force_outputs(const LinearVehicle& vehicle);

/// Reactions of all joints, x, y and torque at their point a.
LinearOutputs make_reaction_outputs(const LinearVehicle& vehicle);

/// The outputs of motion x of the independent coordinates under generalized forces and what these do to the
/// channels directly, for k columns at once (linear, eq. 10).
/// @param x  f×k  @param forces  nq×k  @param channels  of all force elements, ×k  @return p×k
Eigen::MatrixXcd sum_outputs(const LinearOutputs& outputs, double omega, const Eigen::MatrixXcd& x,
                             const Eigen::MatrixXcd& forces, const Eigen::MatrixXcd& channels);

/// Complex amplitudes of the outputs for a wave of 1 m at each input, and nowhere else: p×k. Times
/// calc_delays(): the vehicle on the whole wave.
Eigen::MatrixXcd calc_transfer(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                               const RoadWave& wave);

/// The outputs of a vehicle that goes over a wave of 1 m, its phase zero under the foremost wheel: p.
Eigen::VectorXcd calc_response(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                               const RoadWave& wave);

/// The wave that passes with a frequency at a speed. @param frequency_hz > 0 @param speed > 0 [m/s]
RoadWave make_road_wave(double frequency_hz, double speed);

}  // namespace sprung::dynamics

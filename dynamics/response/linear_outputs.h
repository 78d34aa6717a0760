#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/response/linear_vehicle.h"

namespace sprung::dynamics {

/// The meaning of an output, by which code selects outputs.
struct OutputSubject {
  enum class Kind { kPoint, kMode, kChannel, kReaction, kMoment };
  enum class Derivative { kDisplacement, kVelocity, kAcceleration };
  Kind kind = Kind::kPoint;
  /// Marker; for kMode and kMoment the body, for kChannel the force element, for kReaction the joint.
  int object = 0;
  Derivative derivative = Derivative::kDisplacement;  ///< of a motion
  int component = 0;                                  ///< 0: x, 1: y, 2: angle or torque; for kMode the mode
  ChannelRole role = ChannelRole::kForce;             ///< of a channel
};

/// p outputs of a linear vehicle, named as in a results file. They depend on the motion x of its f
/// independent coordinates, on the generalized forces of the road on its nq coordinates, and on the road
/// directly (response, eq. 4).
struct LinearOutputs {
  std::vector<std::string> names;  ///< "points/chassis.seat/acceleration.y"
  std::vector<std::string> units;
  std::vector<OutputSubject> subjects;
  Eigen::MatrixXd by_position, by_velocity, by_acceleration;  ///< p×f
  Eigen::MatrixXd by_force;                                   ///< p×nq, of the road's generalized forces
  /// p×3 markers, direct effect of a load on each marker beside that of its generalized forces, world axes;
  /// only calls that say so count it.
  Eigen::MatrixXd by_load;
  std::vector<int> channels;  ///< p, the channel whose direct part is added, among all channels; −1 for none

  int size() const { return static_cast<int>(names.size()); }
  /// Adds the outputs of another set after these.
  void append(const LinearOutputs& other);
  /// The outputs in some rows.
  LinearOutputs pick(const std::vector<int>& rows) const;
};

/// Displacement, velocity and acceleration of a marker: x, y and angle of each, world axes, 9 outputs.
LinearOutputs make_point_outputs(const LinearVehicle& vehicle, int marker);

/// Amplitude and acceleration of every mode of every body.
LinearOutputs make_modal_outputs(const LinearVehicle& vehicle);

/// Channels of all force elements, except contact flags and road heights.
LinearOutputs make_force_outputs(const LinearVehicle& vehicle);

/// Accelerations of all coordinates and multipliers per generalized force on each, about the equilibrium.
struct ForceEffects {
  Eigen::MatrixXd accelerations, multipliers;  ///< nq×nq, m×nq
};
ForceEffects calc_force_effects(const LinearVehicle& vehicle);

/// Outputs that are a function of the state, without names, units and subjects. Their effects of forces and
/// loads are zero.
/// @param function  of p values
LinearOutputs make_state_outputs(const LinearVehicle& vehicle, const StateFunction& function);

/// Reactions of all joints, x, y and torque at their point a.
/// Checked by tests/dynamics/response/linear_vehicle_test.cpp
LinearOutputs make_reaction_outputs(const LinearVehicle& vehicle);

/// The outputs for k motions of the independent coordinates at once (response, eq. 4).
/// @param omega     [rad/s]
/// @param x         motions, f×k
/// @param forces    generalized forces of the road, nq×k
/// @param channels  direct effect of the road on the channels of all force elements, k columns
/// @return p×k
Eigen::MatrixXcd sum_outputs(const LinearOutputs& outputs, double omega, const Eigen::MatrixXcd& x,
                             const Eigen::MatrixXcd& forces, const Eigen::MatrixXcd& channels);

/// Complex amplitudes of the outputs for a wave of 1 m at one input at a time: p×k for k inputs. Their
/// product with calc_delays() is the response to a wave under all inputs. Checked by
/// tests/dynamics/response/linear_vehicle_test.cpp
Eigen::MatrixXcd calc_transfer(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                               const RoadWave& wave);

/// The outputs of a vehicle on a wave of 1 m whose phase is zero under the foremost wheel: p.
Eigen::VectorXcd calc_response(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                               const RoadWave& wave);

/// The road wave that excites a vehicle at a speed with a frequency.
/// @param frequency_hz  > 0 [Hz]
/// @param speed         > 0 [m/s]
/// @throws std::invalid_argument if one of them is not positive
RoadWave make_road_wave(double frequency_hz, double speed);

}  // namespace sprung::dynamics

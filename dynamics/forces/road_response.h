#pragma once

#include <Eigen/Core>
#include <complex>

namespace sprung::dynamics {

/// A harmonic road under a force element: h = Re(z e^{i(ωt + κξ)}), where z is the amplitude under the
/// element and ξ the distance ahead of it.
struct RoadWave {
  double wavenumber = 0.0;  ///< κ > 0 [rad/m]
  double frequency = 0.0;   ///< ω = κ · speed [rad/s]
};

/// The position of a force element on the road.
struct RoadPlace {
  double distance = 0.0;    ///< along the road, where ξ of `RoadWave` is 0 [m]
  bool is_pressed = false;  ///< the road exerts a force on it
  bool can_lift = true;     ///< whether it can leave the ground
};

/// Complex amplitudes of the force and torque on a marker for z = 1 m, in world axes.
struct WrenchGain {
  Eigen::Vector2cd force = Eigen::Vector2cd::Zero();  ///< [N/m]
  std::complex<double> torque = 0.0;                  ///< [N·m/m]
};

}  // namespace sprung::dynamics

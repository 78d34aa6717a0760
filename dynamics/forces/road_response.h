#pragma once

#include <Eigen/Core>
#include <complex>

namespace sprung::dynamics {

/// A road of harmonic height as a force element meets it: h = Re(z e^{i(ωt + κξ)}), z the amplitude under the
/// element itself, ξ the distance ahead of it.
struct RoadWave {
  double wavenumber = 0.0;  ///< κ > 0 [rad/m]
  double frequency = 0.0;   ///< ω = κ · speed [rad/s]
};

/// Where a force element stands on the road.
struct RoadPlace {
  double distance = 0.0;    ///< along the road, of what `RoadWave` calls its place [m]
  bool is_pressed = false;  ///< passes on what the road does; not while it is off the ground
};

/// Complex amplitude of force and torque on a marker, world axes, for z = 1 m.
struct WrenchGain {
  Eigen::Vector2cd force = Eigen::Vector2cd::Zero();  ///< [N/m]
  std::complex<double> torque = 0.0;                  ///< [N·m/m]
};

}  // namespace sprung::dynamics

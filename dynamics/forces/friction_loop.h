#pragma once

namespace sprung::dynamics {

/// First harmonic of friction, of its full value, in a steady loop of the deflection d = A sin ωt:
/// p ≈ in_phase sin ωt + ahead cos ωt                                                       (forces, eq. 22)
struct FrictionHarmonic {
  double in_phase = 0.0, ahead = 0.0;
};
/// @param reach  A/β ≥ 0
/// Checked by tests/dynamics/forces/leaf_spring_test.cpp
FrictionHarmonic calc_friction_harmonic(double reach);

/// A linear law of friction.
struct LinearFriction {
  double gain = 1.0;
  double decay = 0.0;  ///< [1/s]
};

/// The linear law ṗ = gain ḋ/β − decay p whose force is nearest to that of friction in a narrow-band random
/// motion: loops of Rayleigh distributed amplitudes, least mean square (forces, eq. 23).
/// @param rms_deflection, rms_rate  > 0 [m, m/s]   @param presliding_deflection  β [m]
/// Checked by tests/dynamics/forces/leaf_spring_test.cpp
LinearFriction linearise_friction(double rms_deflection, double rms_rate, double presliding_deflection);

}  // namespace sprung::dynamics

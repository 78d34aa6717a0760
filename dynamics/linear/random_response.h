#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/linear/linear_outputs.h"
#include "dynamics/road/road_spectrum.h"

namespace sprung::dynamics {

/// A range of frequencies, 0 < from < to [Hz].
struct FrequencyRange {
  double from = 0.0, to = 0.0;
};

/// One-sided spectral densities of the outputs of a vehicle that goes over a random road at a speed, p
/// [unit²/Hz]: |H|² G(n)/V at n = f/V. (linear, eq. 11)
/// @param frequency_hz > 0  @param speed > 0 [m/s]
Eigen::VectorXd calc_response_spectrum(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const RoadSpectrum& road, double speed, double frequency_hz);

/// Root mean squares of the outputs, p: √ of the integral of their spectral densities over a range of
/// frequencies, to about 1e-6 (adaptive Gauss–Kronrod in the logarithm of the frequency, parted at the
/// vehicle's resonances).
/// Source: [Piessens 1983], rule QK15
/// @throws std::invalid_argument for a range or speed that is none
/// @throws support::NumericalError naming the resonance, where the integral does not converge: no damping
/// there
Eigen::VectorXd calc_root_mean_squares(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const RoadSpectrum& road, double speed, const FrequencyRange& range);

/// The root mean square of the road's height over the same range of frequencies [m].
double calc_road_rms(const RoadSpectrum& road, double speed, const FrequencyRange& range);

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/response/linear_outputs.h"
#include "dynamics/road/road_spectrum.h"

namespace sprung::dynamics {

/// A range of frequencies, 0 < from < to [Hz].
struct FrequencyRange {
  double from = 0.0, to = 0.0;
};

/// One-sided spectral densities of the outputs of a vehicle on a random road, p [unit²/Hz]:
/// |H|² G(n)/V at n = f/V (response, eq. 5).
/// @param speed         > 0 [m/s]
/// @param frequency_hz  > 0 [Hz]
Eigen::VectorXd calc_response_spectrum(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const RoadSpectrum& road, double speed, double frequency_hz);

/// Root mean squares of the outputs, p: the square roots of the integrals of their spectral densities over a
/// range of frequencies, accurate to about 1e-6. The integration is adaptive in the logarithm of the
/// frequency, with panels that end at the vehicle's resonances.
/// @throws std::invalid_argument for an empty range or a speed that is not positive
/// @throws support::NumericalError where the integral does not converge at an undamped resonance, which the
///         message names
/// Checked by tests/dynamics/response/linear_vehicle_test.cpp
Eigen::VectorXd calc_root_mean_squares(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const RoadSpectrum& road, double speed, const FrequencyRange& range);

/// The root mean square of the road's height over the same range of frequencies [m].
double calc_road_rms(const RoadSpectrum& road, double speed, const FrequencyRange& range);

}  // namespace sprung::dynamics

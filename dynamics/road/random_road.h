#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/road/road_spectrum.h"

namespace sprung::dynamics {

/// A random road: a sum of cosines with random phases and the amplitudes of a spectral density.
struct RandomRoad {
  RoadSpectrum spectrum;               ///< its scale has no effect where an r.m.s. is given
  double lowest = 0.0, highest = 0.0;  ///< ends of the band that its waves lie in, 0 < lowest < highest [1/m]
  double length = 0.0;                 ///< > 0; the road is periodic in it before its ends are eased [m]
  double rms = 0.0;                    ///< about the mean, or about eased ends; 0: as the spectrum has it [m]
  double ease = 0.0;                   ///< the first and the last metres, 0 ≤ 2 ease < length [m]
  std::uint64_t seed = 1;              ///< of the phases
};

/// Points of a random road at equal distances from 0 to its length, at least six to the shortest wave.
/// @return the heights [m]; the first is 0                                                    (road, eq. 2)
/// @throws std::invalid_argument if no wave of a whole number of periods lies in the band, for more than 1e7
///         points, and for heights that vanish or have an r.m.s. value above 1 km
/// Checked by tests/dynamics/road/random_road_test.cpp
std::vector<double> make_random_heights(const RandomRoad& road);

}  // namespace sprung::dynamics

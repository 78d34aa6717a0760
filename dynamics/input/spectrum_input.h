#pragma once

#include "dynamics/road/random_road.h"
#include "dynamics/road/road_spectrum.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Reads the spectral density of a random road: `class`, or `density` with `exponent`, or `table`; and the
/// `band` outside of which it is zero.
/// @throws support::InputError for a key that is missing, unknown or has a bad value
/// Checked by tests/dynamics/input/response_input_test.cpp
RoadSpectrum read_spectrum_in_band(const support::TomlTable& table);

/// Reads the keys of a road's shape "random": a spectral density or an r.m.s. value, the band, and how its
/// points are made. It does not look for unknown keys.
/// @throws support::InputError for a key that is missing or has a bad value
/// Checked by tests/dynamics/input/road_input_test.cpp
RandomRoad read_random_road(const support::TomlTable& table);

}  // namespace sprung::dynamics

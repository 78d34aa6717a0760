#pragma once

#include <string_view>

#include "dynamics/functions/time_function.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// What a function of time is for: how smooth a table of points has to be made.
enum class TimeFunctionUse {
  kForce,   ///< straight lines between the points of a table
  kMotion,  ///< a curve through them that has a velocity and an acceleration
};

/// Reads a function of time t [s]: a number, which stays the same, or one of
///
///     { polynomial = [a_0, a_1, …] }                                  Σ a_k t^k
///     { harmonic = { mean, amplitude, frequency, phase } }            mean + amplitude sin(2π frequency t +
///     phase) { table = [[t, x], …] }                                         level before the first and
///     after the last point { step = { before, after, start, end } }                        smooth between
///     start and end
///
/// @param unit  of the function's value, for messages
/// @throws support::InputError
TimeFunction read_time_function(const support::TomlValue& value, std::string_view unit, TimeFunctionUse use);

}  // namespace sprung::dynamics

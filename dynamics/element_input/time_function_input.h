#pragma once

#include <string_view>

#include "dynamics/element_input/history_input.h"
#include "dynamics/functions/time_function.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Reads a function of time t [s]: a number, which is constant, or one of
///
///     { polynomial = [a_0, a_1, …] }                          Σ a_k t^k
///     { harmonic = { mean, amplitude, frequency, phase } }    mean + amplitude sin(2π frequency t + phase)
///     { table = [[t, x], …] }                                 constant outside of the points
///     { history = { file, channel, … } }                      measured
///     { step = { before, after, start, end } }                smooth between start and end
///     { sum = [f, …] }, { product = [f, …] }                  of such functions
///     { pieces = [{ until, function }, …, { function }] }     one after the other
///
/// @param unit       of the function's value, for messages
/// @param histories  reads the measured ones
/// @throws support::InputError for a key that is missing, unknown or has a bad value, and for a motion whose
///         value or rate jumps
/// Checked by tests/dynamics/element_input/time_function_input_test.cpp
TimeFunction read_time_function(const support::TomlValue& value, std::string_view unit, TimeFunctionUse use,
                                HistoryFiles& histories);

}  // namespace sprung::dynamics

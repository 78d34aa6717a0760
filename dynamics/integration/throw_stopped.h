#pragma once

#include <string_view>

namespace sprung::dynamics {

/// Ends an integration that cannot continue.
/// @throws support::NumericalError always: "integration stopped at t = … s: reason"
[[noreturn]] void throw_stopped(double time, std::string_view reason);

/// The joints cannot be closed at a time [s]. @throws support::NumericalError
[[noreturn]] void throw_open_joints(double time);

}  // namespace sprung::dynamics

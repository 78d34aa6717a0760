#pragma once

#include <string_view>

namespace sprung::dynamics {

/// Ends an integration that cannot continue.
/// @throws support::NumericalError always: "integration stopped at t = … s: reason"
[[noreturn]] void throw_stopped(double time, std::string_view reason);

}  // namespace sprung::dynamics

#include "dynamics/integration/throw_stopped.h"

#include <fmt/format.h>

#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

void throw_stopped(double time, std::string_view reason) {
  throw support::NumericalError(fmt::format("integration stopped at t = {:.9g} s: {}", time, reason));
}

}  // namespace sprung::dynamics

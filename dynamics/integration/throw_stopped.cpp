#include "dynamics/integration/throw_stopped.h"

#include <fmt/format.h>

#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

void throw_stopped(double time, std::string_view reason) {
  throw support::NumericalError(fmt::format("integration stopped at t = {:.9g} s: {}", time, reason));
}

void throw_open_joints(double time) {
  throw support::NumericalError(fmt::format(
      "the joints cannot be closed at t = {:.9g} s; look at the positions just before that time, where the "
      "mechanism may come to a singular one or to the end of its travel",
      time));
}

}  // namespace sprung::dynamics

#pragma once

#include <stdexcept>

namespace sprung::support {

/// A computation that did not reach its accuracy: no convergence, a singular matrix, a mode that was missed.
/// The message names the time or iteration, the residual, the tolerance and what to try. Exit code 3.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sprung::support

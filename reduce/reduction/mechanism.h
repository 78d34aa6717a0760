#pragma once

#include "reduce/design/design.h"

namespace sprung::reduce {

/// Refuses a body whose lowest mode is lost in rounding. Where nearly all of the mode's strain energy is in
/// one element, the frame gives way there with almost no force, and the message names that element: it is an
/// internal mechanism.
///
/// @param shape  3N×1, of the lowest mode   @param error  of its ω², as from estimate_rounding_error
/// @throws support::NumericalError if the error is above kMaxRoundingError
/// Checked by tests/reduce/reduction/mechanism_test.cpp
void check_rounding(const Design& design, const Eigen::MatrixXd& shape, double error, double frequency_hz);

}  // namespace sprung::reduce

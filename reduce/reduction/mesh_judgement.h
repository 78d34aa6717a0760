#pragma once

#include <string>

#include "reduce/design/design.h"

namespace sprung::reduce {

/// The frequency at which the mesh of a body is judged: the end of the band of its certificate. Where
/// `[modes]` asks for clamped modes other than all, the highest of them, if that is higher [Hz].
double choose_judged_hz(const Design& design, const Superelement& superelement);

/// What the lengths of the elements do to frequencies, as a check without tolerance of the superelement
/// (reduce, "Checks"; fem, eqs. 36, 37).
CheckResult make_mesh_check(const Design& design, double judged_hz);

/// How good the mesh is, in a line; "" of a body without elements.
std::string describe_mesh(const Design& design, double judged_hz);

/// Which element is the worst of a mesh that is too coarse, and how many it should be, or "".
/// Checked by tests/reduce/program/mesh_error_test.py
std::string remark_on_mesh(const Design& design, double judged_hz);

}  // namespace sprung::reduce

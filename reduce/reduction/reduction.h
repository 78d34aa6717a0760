#pragma once

#include "reduce/design/design.h"
#include "reduce/modes/clamped_modes.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Reduces a design to its modes: assembles, solves, proves the count, makes the basis canonical, integrates
/// the inertia, recovers the resultants, and checks the result.
///
/// @param options  the result does not depend on them beyond rounding
/// @throws support::InputError for a request that the frame cannot serve (modes, damping ratios)
///         support::NumericalError where rounding spoils a mode, the modes cannot be proved
///         complete, or a check of the result fails (its value and tolerance)
/// Checked by tests/reduce/truck_test.cpp, tests/reduce/design/design_test.cpp
Superelement make_superelement(const Design& design, const ClampedModeOptions& options = {});

}  // namespace sprung::reduce

#pragma once

#include <string>
#include <vector>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Name of the check of which the tolerance of others depends; recorded when the file is made.
inline constexpr const char* kRoundingCheck = "rounding error of the lowest ω²";

/// Verifies everything that a superelement by itself allows (reduce, "Checks"): orthogonality of
/// the modes, stiffness and damping against the frequencies, the inertia integrals against their components,
/// definiteness of the mass matrix of frame and modes together, the held node, and the resultants against the
/// stiffness and in equilibrium.
///
/// @param superelement  without a fault (superelement_fault.h)
/// Checked by tests/reduce/reduction/superelement_checks_test.cpp
std::vector<CheckResult> check_superelement(const Superelement& superelement);

}  // namespace sprung::reduce

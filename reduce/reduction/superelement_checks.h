#pragma once

#include <string>
#include <vector>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Name of a check recorded when the file is made. The tolerances of other checks depend on its value.
inline constexpr const char* kRoundingCheck = "rounding error of ω²";

/// Its name in files that were made when only the lowest mode was looked at.
inline constexpr const char* kOldRoundingCheck = "rounding error of the lowest ω²";

/// What rounding does to the frame while its reference node carries the whole body (held_rounding.h). Files
/// made before it was looked at have none.
inline constexpr const char* kHeldRoundingCheck = "rounding error of the held frame";

/// Followed by " at F Hz". It has no tolerance, because the mesh is the user's choice.
inline constexpr const char* kMeshCheck = "estimated error of the mesh";

/// Stands for no tolerance. The tools refuse files with much larger numbers.
inline constexpr double kNoTolerance = 1e9;

inline constexpr const char* kMassConditionCheck = "condition of the mass matrix of frame and modes";
inline constexpr const char* kResidualCheck = "residual of the modes";
inline constexpr const char* kPointLoadCheck = "work of the section loads on the modes";

/// Makes every check for which a superelement alone is enough (reduce, "Checks"): orthogonality of
/// the modes, stiffness and damping against the frequencies, the inertia integrals against their components,
/// definiteness of the mass matrix of frame and modes together, the held node, the resultants against the
/// stiffness and in equilibrium, the static flexibility of the interface against the certificate, and the
/// section loads of the points against the modes. A body from matrices has no beams, and no checks of their
/// resultants.
///
/// @param superelement  without a fault (superelement_fault.h)
/// Checked by tests/reduce/reduction/superelement_checks_test.cpp
std::vector<CheckResult> check_superelement(const Superelement& superelement);

}  // namespace sprung::reduce

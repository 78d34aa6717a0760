#pragma once

#include "reduce/basis/basis.h"

namespace sprung::reduce {

/// All free modes below 1.5 times the band's end, and as many residual vectors as the certificate asks for:
/// while its largest share is above the tolerance, K⁻¹r of the worst load at its worst frequency joins
/// (reduce/basis, "Free basis").
///
/// @param problem  of the free body (free_body.h)
/// @param modes    its modes below kBandMargin · request.highest_hz
/// @throws support::NumericalError if the tolerance is not reached (share and tolerance)
/// Checked by tests/reduce/basis/free_basis_test.cpp
FreeBodyBasis make_free_basis(const ModalProblem& problem, const StiffnessFactor& factor,
                              const ModesBelow& modes, const BasisRequest& request);

}  // namespace sprung::reduce

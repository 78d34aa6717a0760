#pragma once

#include <Eigen/SparseCore>

#include "reduce/basis/basis.h"
#include "reduce/modes/free_body.h"

namespace sprung::reduce {

/// The basis of Craig and Bampton: the static response to a displacement of each interface freedom, and the
/// modes below 1.5 times the band's end of the body held at all of them (reduce/basis, "Fixed interface").
/// The reference node is free like any other. The vectors are then those of the problem of the free body
/// projected on that space, with the rigid motions, which it contains, taken out.
///
/// @param problem, modes  of the free body (free_body.h), and its modes below kBandMargin ·
/// request.highest_hz
/// @param rigid            its shapes are zero at nodes that follow others, which have no freedoms
/// @param stiffness, mass  3N×3N, of the free frame
/// @throws support::InputError at request.where if the interface freedoms do not hold the body, or no vector
/// is left
/// Checked by tests/reduce/basis/fixed_interface_basis_test.cpp
FreeBodyBasis make_fixed_interface_basis(const ModalProblem& problem, const StiffnessFactor& factor,
                                         const ModesBelow& modes, const BasisRequest& request,
                                         const RigidMotions& rigid,
                                         const Eigen::SparseMatrix<double>& stiffness,
                                         const Eigen::SparseMatrix<double>& mass);

}  // namespace sprung::reduce

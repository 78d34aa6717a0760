#pragma once

#include "reduce/matrices/matrix_body.h"

namespace sprung::reduce {

/// Records by how much the stiffness resists rigid motion, and makes it that of a free body: the rigid motion
/// of the node nearest to the middle is taken from all motions,
///
///     K' = Pᵀ K P,   P = 1 − R E_cᵀ,   R = 1 at node c                                (reduce/matrices, eq.
///     8)
///
/// so that K' R = 0 to rounding of double numbers, whatever node is the reference.
/// Checked by tests/reduce/matrices/ground_test.py
void release_from_ground(MatrixBody& body);

/// @param lowest_hz  the lowest elastic frequency of the body [Hz]
/// @throws support::InputError if the resistance to rigid motion changes elastic motion, or is more than the
///         digits of the files explain: frequency, stiffness, place, and what to do
void require_no_ground(const MatrixBody& body, double lowest_hz);

/// What the user should know of a resistance that was accepted, or "".
std::string remark_on_ground(const MatrixBody& body, double lowest_hz);

}  // namespace sprung::reduce

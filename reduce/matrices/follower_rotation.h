#pragma once

#include "reduce/matrices/matrix_body.h"

namespace sprung::reduce {

/// Gives stiffness to the freedoms that the files do not have (MatrixBody::is_given). The rotation of a node
/// follows the displacements of the nodes that the stiffness connects it with: a spring acts on its
/// difference from their best rigid rotation (reduce/matrices, eq. 4). It has no mass, so that only a moment
/// on it strains the spring. A freedom across the plane gets a spring of its own.
/// @throws support::InputError if a node without rotation is connected with no other
/// Checked by tests/reduce/matrices/matrices_test.py
void hold_missing_freedoms(MatrixBody& body);

}  // namespace sprung::reduce

#pragma once

#include <Eigen/Core>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Work of the elements' resultants of one set of loads or modes on the displacements of the modes, split by
/// resultant. n modes, k loads; in 1/s² where the loads are those of the modes.
struct ElementWork {
  Eigen::MatrixXd axial;    ///< n×k, Σ [N u] over the elements' ends
  Eigen::MatrixXd bending;  ///< n×k, Σ [Q w + M ψ], shear included
};

/// Of the modes' own resultants (reduce, eq. 25): the sum of both is the modal stiffness, n×n.
/// Checked by tests/reduce/reduction/superelement_checks_test.cpp
ElementWork calc_element_work(const Superelement& superelement);
/// @param resultants  6E×k
ElementWork calc_element_work(const Superelement& superelement, const support::RowMatrix& resultants);

}  // namespace sprung::reduce

#pragma once

#include <Eigen/Core>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Work of the elements' resultants of one set of modes on the displacements of another, split by resultant.
struct ElementWork {
  Eigen::MatrixXd axial;    ///< n×n, Σ [N u] over the elements' ends [1/s²]
  Eigen::MatrixXd bending;  ///< n×n, Σ [Q w + M ψ], shear included [1/s²]
};

/// From shapes and resultants alone (reduce, eq. 23): the sum of both is the modal stiffness.
/// Checked by tests/reduce/reduction/superelement_checks_test.cpp
ElementWork calc_element_work(const Superelement& superelement);

}  // namespace sprung::reduce

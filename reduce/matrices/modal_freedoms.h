#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "reduce/matrices/matrix_system.h"

namespace sprung::reduce {

/// The rows of the modal freedoms of a body that is symmetric about the plane, by the motion that each
/// belongs to.
struct ModalFreedoms {
  std::vector<int> symmetric, antisymmetric;
};

/// A modal freedom belongs to the motion, symmetric T or antisymmetric U, with which the mass couples it
/// more: of a row m of the mass, the larger one of Σ (m T)ᵢ² / (Tᵀ M T)ᵢᵢ and of the same sum of U.
///
/// @param symmetric, antisymmetric  T and U of the freedoms of nodes, n×any
ModalFreedoms divide_modal_freedoms(const MatrixSystem& system, const Eigen::SparseMatrix<double>& symmetric,
                                    const Eigen::SparseMatrix<double>& antisymmetric);

}  // namespace sprung::reduce

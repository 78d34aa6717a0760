#pragma once

#include <Eigen/SparseCore>
#include <utility>
#include <vector>

#include "reduce/matrices/matrix_system.h"

namespace sprung::reduce {

/// A motion of modal freedoms: one of them alone, or a combination of several of equal frequency.
struct ModalMotion {
  int row = 0;                                ///< of the freedom by whose name it goes
  std::vector<std::pair<int, double>> parts;  ///< rows and their amplitudes
};

/// The motions of the modal freedoms of a body that is symmetric about the plane.
struct ModalFreedoms {
  std::vector<ModalMotion> symmetric, antisymmetric;
};

/// A modal freedom belongs to the motion, symmetric T or antisymmetric U, with which the mass couples it
/// more: of a row m of the mass, the larger one of Σ (m T)ᵢ² / (Tᵀ M T)ᵢᵢ and of the same sum of U. Freedoms
/// of equal frequency that the mass couples with both, as the modes of a square bar, are turned into such
/// that it does not.
///
/// @param symmetric, antisymmetric  T and U of the freedoms of nodes, n×any
ModalFreedoms divide_modal_freedoms(const MatrixSystem& system, const Eigen::SparseMatrix<double>& symmetric,
                                    const Eigen::SparseMatrix<double>& antisymmetric);

}  // namespace sprung::reduce

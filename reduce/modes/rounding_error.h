#pragma once

#include <Eigen/Core>

#include "reduce/modes/eigen_pairs.h"

namespace sprung::reduce {

/// Largest estimated relative rounding error of a mode's ω² that is accepted.
inline constexpr double kMaxRoundingError = 1e-4;

/// Estimated relative error of a mode's ω² by rounding of the stiffness matrix. Bending stiffness grows with
/// the cube of the number of elements and the mode's energy does not, so very fine meshes give wrong results.
///
///     4 ε √(Σᵢⱼ (φᵢ Kᵢⱼ φⱼ)²) / ω²                                       (reduce, eq. 7)
///
/// The root of the sum assumes independent rounding errors of the entries. On cantilevers of up to 1000
/// elements the estimate is never below the actual error. On finer ones the error is about a
/// third of it and at most twice it (mechanism.h judges them). The estimate is several times nearer to the
/// error than the bound ε‖K‖‖φ‖²/ω² (table in reduce, "Modes").
///
/// @param shape  n, M-normalised
/// @param omega_squared  > 0 [rad²/s²]
/// @return [-]
/// Checked by tests/reduce/modes/clamped_modes_test.cpp
double estimate_rounding_error(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& shape,
                               double omega_squared);

}  // namespace sprung::reduce

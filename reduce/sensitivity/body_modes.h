#pragma once

#include <Eigen/Core>

#include "reduce/reduction/body_basis.h"

namespace sprung::reduce {

/// Modes with all freedoms of the frame, φᵀMφ = 1.
struct BodyModes {
  Eigen::VectorXd omega_squared;  ///< k
  Eigen::MatrixXd shapes;         ///< 3N×k
  Eigen::VectorXi cluster;        ///< k, as from find_clusters

  Eigen::VectorXd calc_hz() const;
};

/// The lowest modes of a body that is free, or clamped at its reference node. The last one's cluster is
/// whole.
/// @param num_modes  ≥ 1; fewer where the frame has fewer freedoms
/// @throws support::NumericalError  as make_superelement, also where rounding spoils a mode
BodyModes calc_body_modes(const Design& design, const BodyMatrices& matrices, bool is_free, int num_modes);

}  // namespace sprung::reduce

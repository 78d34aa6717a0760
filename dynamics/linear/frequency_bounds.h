#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// Bounds on the undamped frequencies of a model, for each freedom of the motion, without internal states
/// [Hz]. The k-th frequency in ascending order lies between the k-th of both, whatever rounding has done to
/// the stiffness (linear, eqs. 7, 8). The two are equal but for that.
struct FrequencyBounds {
  Eigen::VectorXd lower, upper;  ///< ascending
};

/// Whether a stiffness has a potential; forces that follow a body make it unsymmetric. f×f, f×f.
/// @param unknown  rounding and spread of the stiffness
bool is_symmetric(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& unknown);

/// Those of a vehicle linearised about rest at q.
/// @param stiffness  for each coordinate: of a spring in it without force at q; may be empty
/// @param masses     each is added to the mass matrix of the coordinates and gives bounds of the same
///                   frequencies, of which the tightest count; without mass that is positive it gives none
/// @throws support::NumericalError as linearise, where none of the masses gives bounds, and where the
///         stiffness is not symmetric
FrequencyBounds calc_frequency_bounds(const Model& model, const Eigen::VectorXd& q,
                                      const Eigen::VectorXd& stiffness = {},
                                      const std::vector<Eigen::MatrixXd>& masses = {});

}  // namespace sprung::dynamics

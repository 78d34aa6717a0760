#pragma once

#include <Eigen/Core>

#include "dynamics/mode_choice/watched_quantities.h"
#include "dynamics/response/harmonic_sweep.h"

namespace sprung::dynamics {

/// R.m.s. and largest values of w watched quantities.
struct QuantitySizes {
  Eigen::VectorXd rms, peak;  ///< w
};

/// Factor by which the outputs of a quantity are multiplied at a frequency: −ω² for accelerations, else 1.
double calc_factor(const WatchedQuantity& quantity, double omega);

/// R.m.s. over the period, and largest value relative to the one at the start (mode_choice, eq. 4).
/// @param lines  p×m, of the watched outputs, line k + 1 in column k
/// @param omega  m [rad/s]
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
QuantitySizes calc_sizes(const WatchedQuantities& watched, const RowsXcd& lines,
                         const Eigen::VectorXd& omega);

/// The largest values of some quantities.
/// @param quantities  positions in watched.list
Eigen::VectorXd calc_peaks(const WatchedQuantities& watched, const RowsXcd& lines,
                           const Eigen::VectorXd& omega, const std::vector<std::size_t>& quantities);

/// Size of a quantity, √Σ of the squares of its rows, among static outputs; 0 for accelerations.
double calc_static_size(const WatchedQuantity& quantity, const Eigen::VectorXcd& outputs);

/// Replaces sizes below a hundredth of the largest of the same kind by that hundredth. Torques have a second
/// lower bound, the rounding of the forces times the length.
/// @param sizes   w
/// @param length  the vehicle's length scale [m]
Eigen::VectorXd apply_lower_bounds(const WatchedQuantities& watched, Eigen::VectorXd sizes, double length);

/// Ratio of each entry of `change` to the same entry of `size`; a ratio to 0 counts as 0.
Eigen::VectorXd calc_shares(const Eigen::VectorXd& change, const Eigen::VectorXd& size);

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>

#include "dynamics/linear/harmonic_sweep.h"
#include "dynamics/mode_choice/watched_quantities.h"

namespace sprung::dynamics {

/// How large w watched quantities become.
struct QuantitySizes {
  Eigen::VectorXd rms, peak;  ///< w
};

/// Factor of outputs at one frequency that makes them the quantity: −ω² of accelerations.
double calc_factor(const WatchedQuantity& quantity, double omega);

/// R.m.s. over the period, and largest value counted from that at the start (mode_choice, eq. 4).
/// @param lines  p×m, of the watched outputs, line k + 1 in column k  @param omega  m
QuantitySizes calc_sizes(const WatchedQuantities& watched, const RowsXcd& lines,
                         const Eigen::VectorXd& omega);

/// Largest values alone of some quantities.  @param quantities  places in the list
Eigen::VectorXd calc_peaks(const WatchedQuantities& watched, const RowsXcd& lines,
                           const Eigen::VectorXd& omega, const std::vector<std::size_t>& quantities);

/// √Σ of the squares of a quantity's rows among outputs that do not move.
double calc_static_size(const WatchedQuantity& quantity, const Eigen::VectorXcd& outputs);

/// Sizes with those raised that are below a hundredth of the largest of the same kind, torques also to what
/// is rounding of forces. @param sizes  w  @param length  a vehicle's natural size [m]
Eigen::VectorXd raise_small(const WatchedQuantities& watched, Eigen::VectorXd sizes, double length);

/// Of each what it is of the other; nothing is a share of 0 of nothing.
Eigen::VectorXd divide(const Eigen::VectorXd& change, const Eigen::VectorXd& size);

}  // namespace sprung::dynamics

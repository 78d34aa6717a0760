#pragma once

#include <Eigen/Core>

#include "dynamics/integration/ode_system.h"
#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

/// f blocks of two rows and columns: u̇ = B u for pairs (u_m, u_{f+m}).
struct PairBlocks {
  Eigen::ArrayXd b11, b12, b21, b22;  ///< f [1/s, for the pairs' own units]

  Eigen::Index size() const { return b11.size(); }
  double trace(Eigen::Index m) const { return b11[m] + b22[m]; }
  double determinant(Eigen::Index m) const { return b11[m] * b22[m] - b12[m] * b21[m]; }
  /// du += −B u. @param u, du  2f
  template <class In, class Out>
  void subtract_product(const In& u, Out&& du) const {
    const Eigen::Index f = size();
    du.head(f).array() -= b11 * u.head(f).array() + b12 * u.tail(f).array();
    du.tail(f).array() -= b21 * u.head(f).array() + b22 * u.tail(f).array();
  }
};

/// Coordinates in which small motion falls into uncoupled pairs: (q, v) = T u, u̇ = B u
/// (integration/exponential, eq. 2).
struct VibrationBasis {
  Eigen::MatrixXd T, inverse;  ///< 2f×2f
  PairBlocks blocks;

  /// @param u, state  2f
  void to_state(const Eigen::VectorXd& u, double* state) const { support::multiply(T, u.data(), state); }
  void to_pairs(const double* state, double* u) const { support::multiply(inverse, state, u); }
};

/// Modes with a frequency are coupled by damping; their pairs are the complex modes of that part, in real
/// form. A free motion stays a pair of coordinate and velocity. Where the complex modes are nearly defective,
/// or more than 200, the undamped modes are taken, each with its own damping: damping that couples them is
/// then left out.
/// @throws support::NumericalError if there are no undamped modes: M is not positive definite
VibrationBasis make_vibration_basis(const SmallMotion& motion);

}  // namespace sprung::dynamics

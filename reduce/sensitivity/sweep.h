#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "reduce/design/design.h"
#include "reduce/sensitivity/body_modes.h"

namespace sprung::reduce {

/// Modes that are followed while a design changes. Mode i is the i-th at the beginning.
struct TrackedModes {
  Eigen::VectorXd hz;           ///< n
  Eigen::VectorXd correlation;  ///< n, |φ_oldᵀMφ_new| along the last step, the smaller the less sure
  Eigen::MatrixXd shapes;       ///< 3N×n
  bool is_passed = false;       ///< a mode of the body that is none of them is lower than one of them
};

/// The modes that continue those given: pairs of the largest correlations, each mode once. Within a cluster,
/// whose basis is arbitrary, it is rotated towards the modes given (reduce/sensitivity, eqs. 9, 10).
///
/// @param modes  at least as many   @param mass  3N×3N, of the changed body
/// Checked by tests/reduce/sensitivity/sweep_test.cpp
TrackedModes continue_modes(const TrackedModes& from, const BodyModes& modes,
                            const Eigen::SparseMatrix<double>& mass);

struct SweepOptions {
  DesignSource design;
  std::string key;             ///< of the number that changes
  std::vector<double> values;  ///< that it takes, one after the other
  int num_modes = 6;           ///< free and clamped ones
  /// Only the first value is solved: its modes are the shapes of which those of the others are made.
  bool is_preview = false;
};

struct SweepPoint {
  double value = 0.0;
  TrackedModes free, clamped;
  double mass = 0.0;     ///< [kg]
  double inertia = 0.0;  ///< about the centre of mass [kg·m²]
};

/// Frequencies, mass and inertia of a design while one of its numbers takes other values. Between two values
/// a step is halved while a mode's correlation is below 0.9, at most six times. A preview has Ritz's
/// frequencies, which are not below the true ones (reduce/sensitivity, eq. 11).
///
/// @throws support::InputError if a value makes no design, or one with other nodes (at the key, with the
/// value)
///         support::NumericalError as make_superelement
/// Checked by tests/reduce/sensitivity/sweep_test.cpp
std::vector<SweepPoint> calc_sweep(const SweepOptions& options);

}  // namespace sprung::reduce

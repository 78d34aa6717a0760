#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A model that is softer than the true vehicle, beside the given one, which is stiffer: each body with modes
/// has the soft modes of its certificate as well (reduce/certificate, eq. 8).
struct SoftTwin {
  Model model;
  double highest_hz = 0.0;  ///< the end of the band in which this holds; infinite if no body misses anything
  /// Bodies for which it is not proved: what they carry at rest turns with a reference node of which neither
  /// the soft twin nor the interface has all freedoms.
  std::vector<std::string> unproved;
};

/// @param model  of the vehicle, with the whole basis of each body that has modes
/// @throws support::InputError at a body whose soft twin does not exist: without a bound, with a part of its
/// basis,
///         with stiffening, or with loads at freedoms that are not in its interface
/// Checked by tests/dynamics/input/soft_twin_test.cpp and tests/verification/certified_test.py
SoftTwin make_soft_twin(const Vehicle& vehicle, const Model& model);

/// The coordinates of the soft twin where the model is at q and the soft modes are at rest.
Eigen::VectorXd insert_soft_modes(const Model& model, const SoftTwin& twin, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

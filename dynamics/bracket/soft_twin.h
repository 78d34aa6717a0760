#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/bracket/soft_modes.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The vehicle with the soft modes of the certificate in each body that has modes (reduce/certificate, eqs.
/// 8, 9). As `model` is, it deflects at rest as the true vehicle. In small motion about that it is stiffer
/// than the true one without the soft modes, and softer with what make_softening adds.
struct SoftTwin {
  /// Soft modes of one body: its coordinates after those of its own modes.
  struct SoftBody {
    std::size_t body = 0;
    Eigen::Index num_modes = 0;  ///< of its own
    SoftStiffness stiffness;
  };

  Model model;
  std::vector<SoftBody> bodies;
  std::vector<bool> is_soft;  ///< for each coordinate of `model`
  double highest_hz = 0.0;  ///< the end of the band in which this holds; infinite if no body misses anything
  /// Bodies whose superelement, of an earlier program, does not tell how its soft modes deflect at rest: for
  /// them the above is not proved.
  std::vector<std::string> unproved;
};

/// @param model  of the vehicle, with the whole basis of each body that has modes
/// @throws support::InputError at a body whose soft twin does not exist: without a bound, with a part of its
///         basis, with stiffening, or with loads at freedoms that are not in its interface
/// Checked by tests/dynamics/bracket/soft_twin_test.cpp and tests/verification/certified_test.py
SoftTwin make_soft_twin(const Vehicle& vehicle, const Model& model);

/// The coordinates of the soft twin where the model is at q and the soft modes are at zero.
Eigen::VectorXd insert_soft_modes(const SoftTwin& twin, const Eigen::VectorXd& q);

/// For each coordinate of the soft twin, what its stiffness changes by in small motion, ≤ 0.
Eigen::VectorXd make_softening(const SoftTwin& twin);

/// Mass matrices by which the kinetic energy of the true vehicle is at most above that of the soft twin, and
/// below it, each for other weights of its parts (bracket, eqs. 1, 2). With each of them the bounds hold.
struct UnknownMass {
  std::vector<Eigen::MatrixXd> above;  ///< for the coordinates of the soft twin
  std::vector<Eigen::MatrixXd> below;  ///< for those that are no soft modes
};
/// @param q  coordinates of the soft twin at rest
UnknownMass make_unknown_mass(const SoftTwin& twin, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

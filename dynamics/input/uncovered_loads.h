#pragma once

#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A joint or a force element that acts on a flexible body at a freedom outside of the interface of its
/// superelement. The certificate says nothing about the body's answer to such a load.
struct UncoveredLoad {
  int body = 0;
  std::string point;          ///< "body.point"
  Eigen::Index node = 0;      ///< of the superelement, 0-based
  std::vector<int> freedoms;  ///< ascending, 0 … 2: x, y, rotation; at least one

  /// "body.point takes loads, but 'x' is not in the interface of its superelement"
  std::string describe() const;
};

/// One load at most for each point of each body that has modes and a superelement with a certificate.
/// @param model  of the vehicle
std::vector<UncoveredLoad> find_uncovered_loads(const Vehicle& vehicle, const Model& model);

/// A remark for each body with such loads whose certificate has a bound, with the body's place and what its
/// design lacks. None where the basis holds all motions of the body.
/// Checked by tests/verification/bound_of_run_test.py
std::vector<std::string> list_uncovered_loads(const Vehicle& vehicle, const Model& model);

/// A remark, with the body's place, for each body with a superelement whose centre of mass joints or force
/// elements act on. Checked by tests/verification/supported_beam_test.py
std::vector<std::string> list_spread_loads(const Vehicle& vehicle, const Model& model);

}  // namespace sprung::dynamics

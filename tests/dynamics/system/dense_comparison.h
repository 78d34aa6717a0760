#pragma once

#include <Eigen/Core>

#include "dynamics/system/model.h"

namespace sprung::test {

/// Largest differences between the fast and the plain evaluator at one state, relative to the largest value
/// of the same kind in the system (positions, angles, modal coordinates; multipliers).
struct EvaluatorDifference {
  double position = 0.0, velocity = 0.0;  ///< of the dependents
  double acceleration = 0.0, multiplier = 0.0;
  double kinetic_energy = 0.0;
  double largest() const;
};

/// Both evaluators find dependents, accelerations and multipliers for themselves from the same independents.
///
/// @param assembled    where the partition is chosen and both Newton iterations begin
/// @param q, v         the independents' values are taken from these
/// @param[out] evaluated  the state, with the branches that the force elements chose
/// @throws std::runtime_error where either does not find the dependents
EvaluatorDifference compare_evaluators(const dynamics::Model& model, const Eigen::VectorXd& assembled,
                                       const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                       dynamics::State& evaluated);

}  // namespace sprung::test

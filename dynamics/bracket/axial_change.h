#pragma once

#include <Eigen/Core>
#include <optional>

#include "dynamics/input/make_model.h"

namespace sprung::dynamics {

/// Undamped frequencies of the vehicle with axial forces in its flexible bodies (bodies, "Stiffening"), about
/// the equilibrium that it has with them: those of mode 1, 2, …, ascending [Hz]. None where no superelement
/// has the geometric stiffness of all modes.
/// @param selection  modes of the vehicle
/// @param road       level, has to outlive the call
/// @param q          equilibrium without axial forces, nq
/// @throws support::NumericalError if there is no stable equilibrium
/// Checked by tests/verification/bracket_rounding_test.py
std::optional<Eigen::VectorXd> calc_stiffened_frequencies(const Vehicle& vehicle,
                                                          const ModeSelection& selection,
                                                          const PlacedRoad& road, const Eigen::VectorXd& q);

}  // namespace sprung::dynamics

#pragma once

#include <string>

#include "dynamics/program/prepared_run.h"

namespace sprung::dynamics {

/// The model of a run for `run --dry-run`, as text tables: bodies with their modes, joints with their
/// constraints, force elements, freedoms, and the equilibrium at the start.
std::string format_model(const PreparedRun& prepared);
/// The model as one JSON object, SI units.
std::string format_model_json(const PreparedRun& prepared);

}  // namespace sprung::dynamics

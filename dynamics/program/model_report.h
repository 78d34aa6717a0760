#pragma once

#include <string>

#include "dynamics/program/prepared_run.h"

namespace sprung::dynamics {

/// What a run is made of, for `run --dry-run`: bodies with their modes, joints with what they hold, force
/// elements, freedoms, and the static balance it starts from, as tables for people.
std::string format_model(const PreparedRun& prepared);
/// The same as one JSON object, SI units.
std::string format_model_json(const PreparedRun& prepared);

}  // namespace sprung::dynamics

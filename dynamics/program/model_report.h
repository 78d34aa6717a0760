#pragma once

#include <string>

#include "dynamics/program/prepared_run.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// The model of a run for `run --dry-run`, as text tables: bodies with their modes, joints with their
/// constraints, force elements, freedoms, and the equilibrium at the start.
std::string format_model(const PreparedRun& prepared);
/// The model as one JSON object, SI units.
std::string format_model_json(const PreparedRun& prepared);

/// What a command prints with --json: the run file, what --set has changed, and the members of its report.
std::string format_report_json(const RunRequest& request, const support::Json& report);

}  // namespace sprung::dynamics

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dynamics/output/storage_plan.h"
#include "dynamics/preparation/prepared_run.h"
#include "dynamics/statistics/run_warnings.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// The model of a run for `run --dry-run`, as text tables: bodies with their modes, joints with their
/// constraints, force elements, freedoms, the equilibrium at the start, and the size of the results.
/// @param storage  what a results file would hold
std::string format_model(const PreparedRun& prepared, const StoragePlan& storage);
/// How many coordinates, constraints and freedoms there are, and how the run begins: what assembly moved and
/// what joints changed of the velocities the most, and the balance.
support::Json make_start_json(const PreparedRun& prepared);
/// The model as one JSON object, SI units.
support::Json make_model_json(const PreparedRun& prepared, const StoragePlan& storage);

/// What a command prints with --json: the head that all commands have (dynamics/README.md, "JSON"), and the
/// members of its report. Checked by tests/dynamics/program/json_test.py
std::string format_report_json(const RunRequest& request, std::string_view command,
                               const PreparedRun& prepared, const std::vector<RunWarning>& warnings,
                               const support::Json& report = support::Json::object());

}  // namespace sprung::dynamics

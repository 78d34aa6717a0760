#pragma once

#include "dynamics/output/results_writer.h"

namespace sprung::dynamics {

/// Writes /model/resolved: settings, bodies, points, joints, forces and road as they were run, after
/// overrides and defaults (dynamics/output/results.md). All values are those of the objects that the run
/// uses. Checked by tests/dynamics/program/resolved_model_test.py
void write_resolved_model(support::Hdf5Writer& file, const ResultsHeader& header);

}  // namespace sprung::dynamics

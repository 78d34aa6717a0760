#pragma once

#include "dynamics/output/results_writer.h"

namespace sprung::dynamics {

/// Writes /model/resolved: settings, bodies, points, joints, forces and road as they were run, after
/// overrides and defaults (dynamics/output/results.md). All of it is read from the objects that the run uses.
void write_resolved_model(support::Hdf5Writer& file, const ResultsHeader& header);

}  // namespace sprung::dynamics

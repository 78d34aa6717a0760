#pragma once

#include "dynamics/output/results_writer.h"

namespace sprung::dynamics {

/// Writes /model: everything needed to draw and judge the run without its input files.
void write_results_model(support::Hdf5Writer& file, const ResultsHeader& header);

/// Writes /summary: the statistics that the program prints, without clock times.
void write_results_summary(support::Hdf5Writer& file, const RunStatistics& statistics,
                           const TransientStatistics& transient);

}  // namespace sprung::dynamics

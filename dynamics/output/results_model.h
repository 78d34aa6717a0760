#pragma once

#include <vector>

#include "dynamics/output/results_writer.h"

namespace sprung::dynamics {

/// Heights of the road where the wheels may come, and at the ends of its segments [m].
struct RoadSamples {
  std::vector<double> distance, height;
};
RoadSamples sample_road(const ResultsHeader& header);

/// Writes /model: everything needed to draw and judge the run without its input files.
void write_results_model(support::Hdf5Writer& file, const ResultsHeader& header);

/// Writes /summary, or writes it anew: the statistics that the program prints, without clock times.
void write_results_summary(support::Hdf5Writer& file, const RunStatistics& statistics,
                           const TransientStatistics& transient);

}  // namespace sprung::dynamics

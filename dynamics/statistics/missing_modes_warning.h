#pragma once

#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/simulation/transient_statistics.h"
#include "dynamics/statistics/run_warning.h"

namespace sprung::dynamics {

/// Adds a warning where what a run leaves out of its modes is too much (adaptivity, "Left out together").
void add_missing_modes_warning(const Model& model, const RunStatistics& statistics,
                               const TransientStatistics& transient, const AdaptivityOptions& adaptivity,
                               std::vector<RunWarning>& warnings);

/// The point at which modes left out are missing the most.
std::string name_missing_point(const AdaptivityOptions& adaptivity, const MissingAcceleration& missing);
/// Why what is missing is not estimated. @param missing  with growth
std::string describe_growth(const MissingAcceleration& missing);
/// Follows what modes left out together would add to a run that continues another.
inline constexpr const char* kHistoryUnknown = " (what they did before its start is not known)";

}  // namespace sprung::dynamics

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dynamics/statistics/run_statistics.h"

namespace sprung::dynamics {

/// What a warning is of that concerns all numbers of a run.
inline constexpr std::string_view kComputation = "computation";

/// A doubt about numbers of a run.
struct RunWarning {
  std::string concerns;         ///< which numbers: "summary", "modes"
  std::vector<std::string> of;  ///< their points or bodies, or "computation"
  std::string text;
  bool fails = false;  ///< it is a check of the run that failed: exit code 1
};

// Kinds of numbers that a warning concerns.
inline constexpr const char* kSummary = "summary";
inline constexpr const char* kModes = "modes";

/// A body's rows in the summary: those of its points, and those of its section loads.
std::vector<std::string> list_rows_of(const std::string& body, const RunStatistics& statistics);

}  // namespace sprung::dynamics

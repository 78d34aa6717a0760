#pragma once

#include <string>
#include <vector>

#include "reduce/sensitivity/sweep.h"

namespace sprung::reduce {

/// Correlation below which tables doubt that a mode is the one followed.
inline constexpr double kDoubtfulCorrelation = 0.5;

/// A table of free and one of clamped frequencies; each mode has a column. Lines end in '\n'.
std::string format_sweep(const SweepOptions& options, const std::vector<SweepPoint>& points);
std::string format_sweep_json(const SweepOptions& options, const std::vector<SweepPoint>& points);

}  // namespace sprung::reduce

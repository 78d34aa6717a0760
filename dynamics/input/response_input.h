#pragma once

#include <optional>
#include <vector>

#include "dynamics/element_input/point_reference.h"
#include "dynamics/road/road_spectrum.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// The frequency response that a run file asks for, `[response]`.
struct ResponseRequest {
  enum class Spacing { kLogarithmic, kLinear };
  double from = 0.1, to = 50.0;  ///< 0 < from < to [Hz]
  int number = 1000;             ///< of frequencies, ≥ 2
  Spacing spacing = Spacing::kLogarithmic;
  std::vector<PointReference> points;  ///< if empty, those of the run
  std::optional<RoadSpectrum> road;    ///< if absent, only transfer functions are computed
  support::SourceLocation location;    ///< of the table; without a table, of the file
};

/// Reads `[response]` (dynamics/models/README.md lists the keys).
/// @throws support::InputError at the first key or value that is wrong
/// Checked by tests/dynamics/input/response_input_test.cpp
ResponseRequest read_response(const support::TomlTable& table);

/// The frequencies asked for, ascending, including `from` and `to` [Hz].
std::vector<double> list_frequencies(const ResponseRequest& request);

}  // namespace sprung::dynamics

#pragma once

#include <optional>
#include <vector>

#include "dynamics/input/point_reference.h"
#include "dynamics/road/road_spectrum.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// What a run file asks of the frequency response, `[response]`.
struct ResponseRequest {
  enum class Spacing { kLogarithmic, kLinear };
  double from = 0.1, to = 50.0;  ///< 0 < from < to [Hz]
  int number = 1000;             ///< of frequencies, ≥ 2
  Spacing spacing = Spacing::kLogarithmic;
  std::vector<PointReference> points;  ///< none: the run's
  std::optional<RoadSpectrum> road;    ///< none: frequency response alone
  support::SourceLocation location;    ///< of the table; its path alone where there is none
};

/// Reads `[response]`.
/// @throws support::InputError at the place of whatever does not fit (dynamics/models/README.md lists the
/// keys)
ResponseRequest read_response(const support::TomlTable& table);

/// The frequencies asked for, ascending, `from` and `to` among them [Hz].
std::vector<double> list_frequencies(const ResponseRequest& request);

}  // namespace sprung::dynamics

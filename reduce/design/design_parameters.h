#pragma once

#include <string>
#include <vector>

#include "fem/assembly.h"
#include "reduce/design/design.h"

namespace sprung::reduce {

/// A number of a design, and how its frame changes with it.
struct DesignParameter {
  std::string key;  ///< full, as `--set` takes it: "sections.rail.height", "points.axle.0"
  double value = 0.0;
  std::string unit;
  bool is_coordinate = false;  ///< of a point
  fem::BeamModelRates rates;
};

/// A number of a design that cannot be changed a little both ways as the frame has the same nodes.
struct LeftOutNumber {
  std::string key, reason;
};

/// The parameters of a design that its frame depends on: numbers of materials, sections and point masses, and
/// coordinates of the points that lines end at. Numbers without effect are left out, and so are points that
/// only name a node, and numbers at the end of their range.
///
/// Rates of section properties are five-point differences of what the design gives, exact to rounding for
/// areas and second moments, which are polynomials of the fourth degree at most. Nodes move in proportion to
/// points.
///
/// @param design    as read from the source
/// @param left_out  gets the numbers that have an effect, but no derivative, in the order of the design; or
/// null
/// @throws support::InputError as read_design
/// Checked by tests/reduce/sensitivity/sensitivity_test.cpp
std::vector<DesignParameter> list_parameters(const DesignSource& source, const Design& design,
                                             std::vector<LeftOutNumber>* left_out = nullptr);

}  // namespace sprung::reduce

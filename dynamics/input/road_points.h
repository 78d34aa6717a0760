#pragma once

#include <vector>

#include "dynamics/input/road_input.h"

namespace sprung::dynamics {

/// A measured profile of a road.
struct RoadPoints {
  std::vector<double> distance, height;  ///< ascending, at least 2; the first height is 0 [m]
};

/// Reads the file of a road:
/// - without names of columns, two columns, distance [m] and height [m], separated by blanks or a comma,
///   the first height 0; `#` begins a comment;
/// - with names, the mean of some columns of a text file (measured, "Text files");
/// - the mean of some lines along a road in OpenCRG (measured, "OpenCRG").
/// @throws support::InputError at the line and column of the fault in the file
/// Checked by tests/dynamics/input/road_input_test.cpp
RoadPoints read_road_points(const RoadDescription& road);

}  // namespace sprung::dynamics

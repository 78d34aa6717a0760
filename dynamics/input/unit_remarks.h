#pragma once

#include <string>
#include <vector>

#include "dynamics/input/run.h"
#include "dynamics/input/vehicle.h"

namespace sprung::dynamics {

/// Values of a run and its vehicle that are probably in other units than the SI's: millimetres for metres,
/// kg·mm² for kg·m², km/h for m/s. Each remark has the place of the value. A vehicle may have such values, so
/// they are no errors.
/// Checked by tests/dynamics/input/unit_remarks_test.cpp
std::vector<std::string> list_unit_remarks(const Run& run, const Vehicle& vehicle);

}  // namespace sprung::dynamics

#pragma once

#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"

namespace sprung::dynamics {

/// Values of a vehicle file that are probably in other units than the SI's: millimetres for metres, kg·mm²
/// for kg·m². Each remark has the place of the value. A vehicle may have such values, so they are no errors.
/// Checked by tests/dynamics/input/unit_remarks_test.cpp
std::vector<std::string> list_unit_remarks(const Vehicle& vehicle);

}  // namespace sprung::dynamics

#pragma once

#include <string>
#include <vector>

#include "reduce/design/design.h"

namespace sprung::reduce {

/// Values of a design that are probably in other units than the SI's: a Young's modulus in MPa or GPa, a
/// density in t/mm³ or g/cm³, lengths in mm, a section modulus too large for its section. Each remark names
/// the key. They are no errors. Checked by tests/reduce/design/unit_remarks_test.cpp
std::vector<std::string> list_unit_remarks(const Design& design);

}  // namespace sprung::reduce

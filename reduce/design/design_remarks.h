#pragma once

#include <string>
#include <vector>

#include "reduce/design/design.h"

namespace sprung::reduce {

/// What in a design is probably not meant: values in other units than the SI's (a Young's modulus in MPa or
/// GPa, a density in t/mm³ or g/cm³, lengths in mm), a section modulus too large for its section, nodes that
/// lie on elements to which they are not joined, points that no vehicle can name. They are no errors. Checked
/// by tests/reduce/design/design_remarks_test.cpp
std::vector<std::string> list_design_remarks(const Design& design);

inline constexpr const char* kPlainNames = "names in it are letters, digits, '_' and '-' alone";

}  // namespace sprung::reduce

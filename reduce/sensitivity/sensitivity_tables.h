#pragma once

#include <string>

#include "reduce/sensitivity/sensitivity.h"

namespace sprung::reduce {

/// A change of a parameter that tables speak of: 1 % of it; 1 cm of a coordinate; 1 (in its unit) of a zero.
double choose_step(const DesignParameter& parameter);

/// For people: what each parameter changes by a step of it, in %; lines end in '\n'.
std::string format_sensitivity(const Design& design, const DesignSensitivity& sensitivity);

/// The numbers that have no row, and why; "" where there is none.
std::string format_left_out(const std::vector<LeftOutNumber>& left_out);
/// All derivatives in SI units, the numbers without derivatives, and the shares of the elements.
std::string format_sensitivity_json(const Design& design, const DesignSensitivity& sensitivity,
                                    const std::vector<LeftOutNumber>& left_out);

}  // namespace sprung::reduce

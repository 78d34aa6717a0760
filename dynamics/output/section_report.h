#pragma once

#include <string>

#include "dynamics/section_loads/section_statistics.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// The largest bending moment along the beams of each body, from its loads and from its modes, as a table
/// with a heading; empty where there are none. @param at_rest  of an equilibrium, which has no times
std::string format_sections(const SectionStatistics& statistics, bool at_rest = false);

/// The largest axial force, shear force and bending moment of each body, SI units.
support::Json make_sections_json(const SectionStatistics& statistics);

}  // namespace sprung::dynamics

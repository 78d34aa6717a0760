#pragma once

#include <string>
#include <string_view>

#include "dynamics/description/element_description.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::dynamics {

/// Writes a number as the attribute `name` of a group, with its unit in the attribute `name`_unit.
void write_number(support::Hdf5Writer& file, const std::string& group, const std::string& name, double value,
                  std::string_view unit);

/// Writes the description of an element into its group: the attributes `drawing` and `on_road`, and the group
/// `parameters` (dynamics/output/results.md, "The model as run").
/// @param group  of the element, must exist
/// Checked by tests/dynamics/program/resolved_model_test.py
void write_description(support::Hdf5Writer& file, const std::string& group,
                       const ElementDescription& description);

}  // namespace sprung::dynamics

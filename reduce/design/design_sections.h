#pragma once

#include <map>
#include <optional>
#include <string>

#include "fem/beam_properties.h"
#include "fem/material.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// Which beam theory a design's elements follow.
struct BeamTheory {
  bool shear_deformation = false;  ///< Timoshenko instead of Euler–Bernoulli
  bool rotary_inertia = false;
};

using Materials = std::map<std::string, fem::Material>;
using Sections = std::map<std::string, fem::BeamProperties>;

/// Reads `theory` and `rotary_inertia` of a design.
/// @throws support::InputError for a bad value
BeamTheory read_beam_theory(const support::TomlTable& root);

/// Reads `[materials.NAME]` of a design.
/// @throws support::InputError for a key that is missing, unknown or has a bad value
Materials read_materials(const support::TomlTable& root);

/// A line whose section changes from its beginning to its end: each element has the section at its middle,
/// with all numbers of the sections' tables interpolated linearly.
struct TaperedLine {
  std::string key;  ///< of its table
  int num_elements = 1;
  std::string section_name(int element) const;  ///< of a 0-based element
};

inline constexpr int kMostElements = 100000;  ///< of a line

/// The taper of a table of `[[lines]]`, none if the line has one section.
/// @throws support::InputError if it names other than two sections, or is no straight line
std::optional<TaperedLine> find_taper(const support::TomlTable& line);

/// Name of the section that the element of a table of `[[springs]]` has: no other spring has it.
std::string name_spring_section(const support::TomlTable& spring);

/// Reads `[sections.NAME]` of a design: by shape or by area and second moment, times `count`; and makes the
/// sections of tapered lines and of springs.
/// @throws support::InputError for a key that is missing, unknown or has a bad value, and for a taper between
/// sections of different kinds
/// Checked by tests/reduce/design/design_sections_test.cpp
Sections read_sections(const support::TomlTable& root, const Materials& materials, const BeamTheory& theory);

}  // namespace sprung::reduce

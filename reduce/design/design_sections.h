#pragma once

#include <map>
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

/// Reads `[sections.NAME]` of a design: by shape or by area and second moment, times `count`.
/// @throws support::InputError for a key that is missing, unknown or has a bad value
/// Checked by tests/reduce/design/design_sections_test.cpp
Sections read_sections(const support::TomlTable& root, const Materials& materials, const BeamTheory& theory);

}  // namespace sprung::reduce

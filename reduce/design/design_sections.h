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

/// `theory` and `rotary_inertia` of a design. @throws support::InputError
BeamTheory read_beam_theory(const support::TomlTable& root);

/// `[materials.NAME]` of a design. @throws support::InputError
Materials read_materials(const support::TomlTable& root);

/// `[sections.NAME]` of a design: by shape or by area and second moment, times `count`. @throws
/// support::InputError Checked by tests/reduce/design/design_sections_test.cpp
Sections read_sections(const support::TomlTable& root, const Materials& materials, const BeamTheory& theory);

}  // namespace sprung::reduce

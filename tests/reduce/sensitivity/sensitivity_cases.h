#pragma once

#include <algorithm>
#include <string>

#include "reduce/sensitivity/sensitivity.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

// What the tests of derivatives share: designs, and all derivatives of one.
namespace sprung::reduce {

// A frame with a closed loop, shear, rotary inertia, three shapes of section and a point mass.
inline constexpr const char* kFrame = R"(
theory = "timoshenko"
rotary_inertia = true
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
poissons_ratio = 0.3
[materials.alloy]
youngs_modulus = 7.0e10
density = 2700.0
poissons_ratio = 0.33
[sections.rail]
material = "steel"
shape = "box"
width = 0.08
height = 0.16
wall = 0.005
count = 2
[sections.post]
material = "alloy"
shape = "i_section"
height = 0.12
flange_width = 0.06
flange_thickness = 0.008
web_thickness = 0.005
[sections.arm]
material = "steel"
area = 1.1e-3
second_moment = 4.0e-7
mass_per_length = 9.0
shear_coefficient = 0.6
[points]
middle = [0.0, 0.0]
right = [1.9, 0.1]
top = [1.2, 0.8]
left = [-1.4, -0.2]
[[lines]]
through = ["left", "middle", "right"]
section = "rail"
elements = [4, 4]
[[lines]]
through = ["right", "top"]
section = "post"
elements = 3
[[lines]]
through = ["top", "middle"]
section = "arm"
elements = 3
[[point_masses]]
point = "top"
mass = 12.0
inertia = 0.4
[reference]
point = "middle"
[interface]
left = "xy"
right = "yr"
[reduction]
highest_frequency = 100.0
[modes]
damping_ratio = 0.01
)";

inline constexpr const char* kBeam = R"(
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.beam]
material = "steel"
area = 0.005
second_moment = 4e-6
[points]
a = [0.0, 0.0]
b = [4.0, 0.0]
[[lines]]
from = "a"
to = "b"
section = "beam"
elements = 12
[reference]
point = "a"
[interface]
a = "xyr"
b = "xyr"
[reduction]
highest_frequency = 300.0
[modes]
damping_ratio = 0.02
)";

inline DesignSource write_design(const std::string& name, const std::string& text) {
  testing::write_text(name, text);
  return {.path = name};
}

inline DesignSensitivity calc_all(const DesignSource& source, int num_modes) {
  const Design design = read_design(source);
  return calc_sensitivity(design, list_parameters(source, design), num_modes);
}

inline const ParameterSensitivity& find(const DesignSensitivity& sensitivity, const std::string& key) {
  const auto found = std::find_if(sensitivity.parameters.begin(), sensitivity.parameters.end(),
                                  [&](const ParameterSensitivity& one) { return one.parameter.key == key; });
  REQUIRE(found != sensitivity.parameters.end());
  return *found;
}

}  // namespace sprung::reduce

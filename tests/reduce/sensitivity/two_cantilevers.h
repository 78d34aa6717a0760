#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace sprung::reduce {

/// A design of two steel cantilevers, 2 m long and 50 mm wide, on one clamped node. @param  heights [m]
inline std::string make_cantilevers(double first_height, double second_height) {
  std::string text = R"(
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[points]
middle = [0.0, 0.0]
left = [-2.0, 0.0]
right = [2.0, 0.0]
[[lines]]
from = "left"
to = "middle"
section = "first"
elements = 12
[[lines]]
from = "middle"
to = "right"
section = "second"
elements = 12
[reference]
point = "middle"
[modes]
count = 4
damping_ratio = 0.01
)";
  for (const auto& [name, height] : {std::pair{"first", first_height}, {"second", second_height}}) {
    text +=
        fmt::format("[sections.{}]\nmaterial = \"steel\"\nshape = \"rectangle\"\nwidth = 0.05\nheight = {}\n",
                    name, height);
  }
  return text;
}

}  // namespace sprung::reduce

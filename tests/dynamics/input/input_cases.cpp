#include "tests/dynamics/input/input_cases.h"

#include <stdexcept>

#include "tests/dynamics/input/lumped_superelement.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/toml/toml.h"

namespace sprung::test {

std::string with_change(const std::string& text, const std::string& old_part, const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  if (at == std::string::npos || text.find(old_part, at + 1) != std::string::npos) {
    throw std::logic_error("with_change: not there exactly once: " + old_part);
  }
  std::string changed = text;
  return changed.replace(at, old_part.size(), new_part);
}

std::string input_error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const support::InputError& error) {
    return error.what();
  }
  return "no error";
}

std::filesystem::path superelement_folder() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path made = "superelements";
    write_lumped_superelement({.name = "frame",
                               .nodes = {{"", {0.0, 0.0}, 3.0},
                                         {"left", {-1.2, 0.1}, 2.0},
                                         {"right", {1.3, -0.2}, 4.0},
                                         {"top", {0.2, 0.8}, 1.5}},
                               .frequencies = {5.0, 5.0, 12.0, 20.0}},
                              made);
    return made;
  }();
  return folder;
}

const std::string& cart_text() {
  static const std::string text = R"(name = "cart"
heading = "+x"
gravity = [0.5, -9.0]
monitor = ["frame.seat", "arm.tip"]

[bodies.frame]
superelement = "frame"
position = [2.0, 1.0]
angle = 0.3
[bodies.frame.points]
seat = { node = "top", offset = [0.1, 0.4] }

[bodies.arm]
mass = 4.0
inertia = 0.7
position = [3.5, 0.9]
[bodies.arm.points]
tip = [0.6, -0.1]
root = [-0.6, 0.0]

[ground.points]
peg = [9.0, 0.2]

[[joints]]
name = "hinge"
type = "revolute"
a = "frame.right"
b = "arm.root"

[[forces]]
name = "rope"
type = "spring-damper"
a = "arm.tip"
b = "ground.peg"
multiplicity = 3
free_length = 5.5
spring = { polynomial = [10.0, 200.0, 30.0] }
compression_stop = { deflection = 0.4, rate = 5000.0 }
rebound_stop = { deflection = -0.2, rate = 3000.0 }
damper = { compression = 7.0, rebound = 11.0 }

[[forces]]
name = "wheel"
type = "tyre"
wheel = "frame.left"
radius = 0.5
multiplicity = 2
spring = { polynomial = [0.0, 1000.0, 600.0] }
damping = 40.0
)";
  return text;
}

dynamics::Vehicle read_cart(const std::string& text) {
  return dynamics::read_vehicle(support::TomlDocument::parse(text, "cart.toml"), superelement_folder());
}

}  // namespace sprung::test

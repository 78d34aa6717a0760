#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dynamics/functions/piecewise_polynomial.h"
#include "dynamics/functions/time_function.h"

namespace sprung::dynamics {

/// A value that an element was made with, SI units.
struct Parameter {
  using Value = std::variant<double, bool, std::string, Eigen::Vector2d, std::vector<double>,
                             PiecewisePolynomial, TimeFunction>;
  std::string name;  ///< "free_length"
  Value value;
  std::string unit = {};           ///< of the value; empty for texts and flags
  std::string argument_unit = {};  ///< of the variable of a function
};

/// How a picture of the vehicle shows an element.
enum class Drawing {
  kNone,
  kWheel,   ///< a circle of its parameter `radius` about its first point
  kSpring,  ///< between its two points
  kRod,     ///< a line between its two points
  kPin,     ///< a mark at its first point
};

/// As in results files: "wheel".
std::string_view drawing_name(Drawing drawing);

/// What a joint, force element or road says of itself, besides its name and kind. Whoever writes or shows a
/// model needs no more, so that a new kind of element asks for no change there.
struct ElementDescription {
  std::vector<std::string> points;  ///< what each of its markers is to it: "a", "b", "wheel"
  std::vector<Parameter> parameters;
  Drawing drawing = Drawing::kNone;
  bool on_road = false;  ///< stands on the road of the run
};

}  // namespace sprung::dynamics

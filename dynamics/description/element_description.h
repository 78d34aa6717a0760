#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dynamics/functions/piecewise_polynomial.h"
#include "dynamics/functions/time_function.h"

namespace sprung::dynamics {

/// A value that an element was constructed with, SI units.
struct Parameter {
  using Value = std::variant<double, bool, std::string, Eigen::Vector2d, std::vector<double>,
                             PiecewisePolynomial, TimeFunction>;
  std::string name;  ///< "free_length"
  Value value;
  std::string unit = {};           ///< of the value; empty for texts and flags
  std::string argument_unit = {};  ///< of the independent variable, where the value is a function
};

/// How a picture of the vehicle shows an element.
enum class Drawing {
  kNone,
  kWheel,   ///< of forces alone: a circle of its parameter `radius` about its point `wheel`
  kSpring,  ///< between its points a and b: a suspension, whose travel is its deflection
  kRod,     ///< a line between its points a and b
  kPin,     ///< a mark at its point a
};

/// The name that a results file uses: "wheel".
std::string_view drawing_name(Drawing drawing);

/// How a joint, force element or road describes itself, besides its name and kind. Code that writes or draws
/// a model uses this alone, so a new kind of element needs no change there. Parameters of these names have a
/// meaning for the tools: `radius` of a wheel; `compression_stop`, `rebound_stop`, the deflections at which
/// stops begin.
/// Checked by tests/dynamics/program/resolved_model_test.py
struct ElementDescription {
  std::vector<std::string> points;  ///< the role of each of its markers: "a", "b", "wheel"
  std::vector<Parameter> parameters;
  Drawing drawing = Drawing::kNone;
  bool on_road = false;  ///< whether it stands on the road of the run
};

}  // namespace sprung::dynamics

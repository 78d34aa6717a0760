#include "dynamics/description/element_description.h"

namespace sprung::dynamics {

std::string_view drawing_name(Drawing drawing) {
  switch (drawing) {
    case Drawing::kNone:
      return "none";
    case Drawing::kWheel:
      return "wheel";
    case Drawing::kSpring:
      return "spring";
    case Drawing::kRod:
      return "rod";
    case Drawing::kPin:
      return "pin";
  }
  return "";
}

}  // namespace sprung::dynamics

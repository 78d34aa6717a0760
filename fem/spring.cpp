#include "fem/spring.h"

#include <fmt/format.h>

#include <stdexcept>

namespace sprung::fem {

double calc_largest_transverse_stiffness(double rotational, double length) {
  return 12.0 * rotational / (length * length);
}

BeamProperties make_spring_properties(const Spring& spring, double length) {
  const double largest = calc_largest_transverse_stiffness(spring.rotational, length);
  if (!(length > 0.0 && spring.axial > 0.0 && spring.rotational > 0.0 && spring.transverse > 0.0 &&
        spring.transverse <= largest)) {
    throw std::invalid_argument(
        fmt::format("make_spring_properties: length {} m, axial {} N/m, rotational {} N·m, transverse {} N/m "
                    "(at most {})",
                    length, spring.axial, spring.rotational, spring.transverse, largest));
  }
  BeamProperties properties{.axial_rigidity = spring.axial * length,
                            .bending_rigidity = spring.rotational * length};
  if (spring.transverse < largest)
    properties.shear_rigidity = length / (1.0 / spring.transverse - 1.0 / largest);
  return properties;
}

}  // namespace sprung::fem

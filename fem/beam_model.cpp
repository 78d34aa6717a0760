#include "fem/beam_model.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sprung::fem {

BeamElement make_element(const BeamModel& model, int element) {
  const Mesh::Element& item = model.mesh.elements.at(static_cast<std::size_t>(element));
  return {.first = model.mesh.node_positions.col(item.first),
          .second = model.mesh.node_positions.col(item.second),
          .properties = model.sections[static_cast<std::size_t>(item.section)]};
}

void check_beam_model(const BeamModel& model, const char* function) {
  check_mesh_indices(model.mesh, function);
  if (model.sections.size() != model.mesh.section_names.size()) {
    throw std::invalid_argument(
        fmt::format("{}: sections has {} entries, expected {}, one for each section of the mesh", function,
                    model.sections.size(), model.mesh.section_names.size()));
  }
  for (const BeamProperties& section : model.sections) check_beam_properties(section, function);
  for (const PointMass& point : model.point_masses) {
    if (point.node < 0 || point.node >= model.mesh.num_nodes()) {
      throw std::invalid_argument(fmt::format("{}: point mass at node {}, expected 0 … {}", function,
                                              point.node, model.mesh.num_nodes() - 1));
    }
    if (!(point.mass >= 0.0) || std::isinf(point.mass)) {
      throw std::invalid_argument(
          fmt::format("{}: point mass is {} kg, expected a finite value ≥ 0", function, point.mass));
    }
    if (!(point.inertia >= 0.0) || std::isinf(point.inertia)) {
      throw std::invalid_argument(fmt::format(
          "{}: inertia of a point mass is {} kg·m², expected a finite value ≥ 0", function, point.inertia));
    }
  }
}

}  // namespace sprung::fem

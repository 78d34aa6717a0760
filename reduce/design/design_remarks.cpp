#include "reduce/design/design_remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/support/errors/input_error.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

namespace {

constexpr double kSoftest = 1e6;       // Pa: rubber
constexpr double kLightest = 10.0;     // kg/m³: foam
constexpr double kHeaviest = 30000.0;  // kg/m³
constexpr double kLongest = 200.0;     // m, of a frame

void remark_on_material(const support::TomlTable& material, std::vector<std::string>& remarks) {
  const auto read = [&](const char* key) {
    const std::optional<support::TomlValue> value = material.find(key);
    return value ? std::optional(value->number(support::any(""))) : std::nullopt;
  };
  const std::optional<double> modulus = read("youngs_modulus"), density = read("density");
  if (modulus && *modulus < kSoftest) {
    remarks.push_back(
        fmt::format("'{}.youngs_modulus' is {:.4g} Pa, softer than rubber; steel has 2.1e11 Pa, which is "
                    "210000 MPa",
                    material.key(), *modulus));
  }
  if (density && *density > 0.0 && (*density < kLightest || *density > kHeaviest)) {
    remarks.push_back(fmt::format(
        "'{}.density' is {:.4g} kg/m³; steel has 7850 kg/m³, which is 7.85 g/cm³ or 7.85e-9 t/mm³",
        material.key(), *density));
  }
}

// Of a section that is larger than the whole frame: √A, or the radius of gyration √(I/A).
void remark_on_size(const std::string& name, const fem::BeamProperties& section, double extent,
                    std::vector<std::string>& remarks) {
  if (section.bushing) return;
  const double side = std::sqrt(section.area);
  const double gyration = std::sqrt(section.bending_rigidity / section.axial_rigidity);
  if (std::max(side, gyration) <= extent) return;
  remarks.push_back(fmt::format(
      "'sections.{}' has the area of a square of {:.4g} m and a radius of gyration of {:.4g} m, in a frame "
      "of {:.4g} m; dimensions are in m, not in mm",
      name, side, gyration, extent));
}

// The mean square of the distances from the centroid is I/A, so that the largest, I/W, is at least √(I/A).
void remark_on_section(const std::string& name, const fem::BeamProperties& section,
                       std::vector<std::string>& remarks) {
  const double largest = section.area * std::sqrt(section.bending_rigidity / section.axial_rigidity);
  if (section.section_modulus <= largest) return;
  remarks.push_back(
      fmt::format("'sections.{}.section_modulus' is {:.4g} m³ (parallel members together); a section of this "
                  "area and second moment has at most {:.4g} m³",
                  name, section.section_modulus, largest));
}

// Nodes inside an element that do not belong to it: lines are joined at common points only. Of large meshes
// only the ends of lines are looked at.
void remark_on_touching(const fem::Mesh& mesh, std::vector<std::string>& remarks) {
  constexpr double kMostPairs = 1e8, kTouching = 1e-9;  // of the extent
  constexpr std::size_t kMostNamed = 3;
  std::vector<int> num_elements(static_cast<std::size_t>(mesh.num_nodes()), 0);
  for (const fem::Mesh::Element& element : mesh.elements)
    for (const int node : {element.first, element.second}) ++num_elements[static_cast<std::size_t>(node)];
  const bool is_large = 1.0 * mesh.num_nodes() * mesh.num_elements() > kMostPairs;
  std::vector<int> looked_at;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const int num = num_elements[static_cast<std::size_t>(node)];
    if (num > 0 && (num == 1 || !is_large)) looked_at.push_back(node);
  }
  if (1.0 * static_cast<double>(looked_at.size()) * mesh.num_elements() > kMostPairs) return;
  const double tolerance = kTouching * fem::calc_extent(mesh);
  std::vector<std::string> found;
  for (const fem::Mesh::Element& element : mesh.elements) {
    const Eigen::Vector2d start = mesh.node_positions.col(element.first);
    const Eigen::Vector2d along = mesh.node_positions.col(element.second) - start;
    for (const int node : looked_at) {
      if (node == element.first || node == element.second) continue;
      const Eigen::Vector2d to_node = mesh.node_positions.col(node) - start;
      const double share = to_node.dot(along) / along.squaredNorm();
      if (share > 0.0 && share < 1.0 && (to_node - share * along).norm() <= tolerance)
        found.push_back(fem::describe_node(mesh, node));
    }
  }
  if (found.empty()) return;
  const std::size_t num_others = found.size() - std::min(found.size(), kMostNamed);
  found.resize(std::min(found.size(), kMostNamed));
  remarks.push_back(
      fmt::format("{}{} on a line without being joined to it; lines are joined at common points only",
                  fmt::join(found, ", "),
                  num_others > 0     ? fmt::format(" and {} more lie", num_others)
                  : found.size() > 1 ? " lie"
                                     : " lies"));
}

}  // namespace

std::vector<std::string> list_design_remarks(const Design& design) {
  std::vector<std::string> remarks;
  const support::TomlDocument document =
      support::TomlDocument::parse(design.provenance.design_text, design.name);
  if (const std::optional<support::TomlTable> materials = document.root().find_table("materials")) {
    for (const auto& [name, material] : materials->entries()) remark_on_material(material.table(), remarks);
  }
  const double extent = fem::calc_extent(design.model.mesh);
  for (std::size_t i = 0; i < design.model.sections.size(); ++i) {
    remark_on_size(design.model.mesh.section_names[i], design.model.sections[i], extent, remarks);
    remark_on_section(design.model.mesh.section_names[i], design.model.sections[i], remarks);
  }
  if (extent > kLongest) {
    remarks.push_back(fmt::format("the frame is {:.4g} m long; lengths are in m, not in mm", extent));
  }
  if (const std::optional<support::TomlTable> points = document.root().find_table("points")) {
    for (const auto& [name, point] : points->entries()) {
      if (!support::is_plain_name(name))
        remarks.push_back(fmt::format("no vehicle can name the point '{}': {}", name, kPlainNames));
    }
  }
  const bool joins_otherwise = document.root().has("foundations") || !design.model.couplings.empty();
  if (!joins_otherwise) remark_on_touching(design.model.mesh, remarks);
  return remarks;
}

}  // namespace sprung::reduce

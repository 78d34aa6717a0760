#include "reduce/design/unit_remarks.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

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

}  // namespace

std::vector<std::string> list_unit_remarks(const Design& design) {
  std::vector<std::string> remarks;
  const support::TomlDocument document =
      support::TomlDocument::parse(design.provenance.design_text, design.name);
  if (const std::optional<support::TomlTable> materials = document.root().find_table("materials")) {
    for (const auto& [name, material] : materials->entries()) remark_on_material(material.table(), remarks);
  }
  for (std::size_t i = 0; i < design.model.sections.size(); ++i)
    remark_on_section(design.model.mesh.section_names[i], design.model.sections[i], remarks);
  const Eigen::Matrix2Xd& places = design.model.mesh.node_positions;
  const double longest = (places.rowwise().maxCoeff() - places.rowwise().minCoeff()).norm();
  if (longest > kLongest) {
    remarks.push_back(fmt::format("the frame is {:.4g} m long; lengths are in m, not in mm", longest));
  }
  return remarks;
}

}  // namespace sprung::reduce

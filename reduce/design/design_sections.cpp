#include "reduce/design/design_sections.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fem/section_shapes.h"
#include "reduce/design/known_keys.h"
#include "reduce/design/sizes.h"

namespace sprung::reduce {

namespace {

using support::TomlTable;
using support::TomlValue;

const std::array<std::string, 4> kShapes{"rectangle", "box", "tube", "i_section"};

template <typename Value>
std::vector<std::string> get_names(const std::map<std::string, Value>& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

fem::Material read_material(const std::string& name, const TomlTable& table) {
  expect_keys(table, {"youngs_modulus", "density", "poissons_ratio"});
  fem::Material material{.name = name,
                         .youngs_modulus = read_size(table, "youngs_modulus", "Pa", kModuli),
                         .density = 0.0,
                         .poissons_ratio = std::numeric_limits<double>::quiet_NaN()};
  if (table.has("density")) material.density = read_size(table, "density", "kg/m³", kDensities);
  if (const auto ratio = table.find("poissons_ratio")) {
    material.poissons_ratio = ratio->number({.unit = "", .above = -1.0, .at_most = 0.5});
  }
  return material;
}

const fem::Material& find_material(const TomlTable& section, const Materials& materials) {
  const TomlValue name = section.at("material");
  const auto found = materials.find(name.string());
  if (found != materials.end()) return found->second;
  throw name.error(fmt::format("names the material '{}', which is not defined{}", name.string(),
                               support::nearest_name_hint(name.string(), get_names(materials))));
}

fem::SectionGeometry calc_shape(const std::string& shape, const TomlTable& table, double poissons_ratio) {
  const auto length = [&](const char* key) { return read_size(table, key, "m", kLengths); };
  if (shape == "rectangle") {
    return fem::calc_section_geometry(fem::Rectangle{.width = length("width"), .height = length("height")},
                                      poissons_ratio);
  }
  if (shape == "box") {
    return fem::calc_section_geometry(
        fem::Box{.width = length("width"), .height = length("height"), .wall = length("wall")},
        poissons_ratio);
  }
  if (shape == "tube") {
    return fem::calc_section_geometry(
        fem::Tube{.outer_diameter = length("outer_diameter"), .wall = length("wall")}, poissons_ratio);
  }
  return fem::calc_section_geometry(fem::ISection{.height = length("height"),
                                                  .flange_width = length("flange_width"),
                                                  .flange_thickness = length("flange_thickness"),
                                                  .web_thickness = length("web_thickness")},
                                    poissons_ratio);
}

// Area, second moment, section modulus (0 where the section leaves it open) and shear coefficient (NaN
// there).
fem::SectionGeometry read_geometry(const TomlTable& table, const fem::Material& material) {
  fem::SectionGeometry geometry;
  if (const auto shape = table.find("shape")) {
    // Only the shear coefficient depends on Poisson's ratio, and it is not used without one.
    const double poissons_ratio = std::isnan(material.poissons_ratio) ? 0.0 : material.poissons_ratio;
    try {
      geometry = calc_shape(shape->one_of(kShapes), table, poissons_ratio);
    } catch (const std::invalid_argument& fault) {
      throw table.error(fmt::format("is no possible section: {}", fault.what()));
    }
    if (!(geometry.area > 0.0 && geometry.second_moment > 0.0)) {
      throw table.error(
          fmt::format("has the area {:.3g} m² and the second moment {:.3g} m⁴: rounding leaves "
                      "nothing of walls as thin as these",
                      geometry.area, geometry.second_moment));
    }
  } else {
    geometry = {.area = read_size(table, "area", "m²", kAreas),
                .second_moment = read_size(table, "second_moment", "m⁴", kSecondMoments),
                .shear_coefficient = std::numeric_limits<double>::quiet_NaN()};
    if (table.has("section_modulus"))
      geometry.section_modulus = read_size(table, "section_modulus", "m³", kSectionModuli);
  }
  if (table.has("shear_coefficient")) {
    geometry.shear_coefficient = read_size(table, "shear_coefficient", "", kShearCoefficients);
  }
  return geometry;
}

double read_mass_per_length(const TomlTable& table, const fem::Material& material, double area) {
  if (table.has("mass_per_length")) return read_size(table, "mass_per_length", "kg/m", kMassesPerLength);
  if (material.density > 0.0) return material.density * area;
  throw table.error(
      fmt::format("needs 'mass_per_length', because material '{}' has no 'density'", material.name));
}

double calc_shear_rigidity(const TomlTable& table, const fem::Material& material,
                           const fem::SectionGeometry& geometry) {
  if (std::isnan(material.poissons_ratio)) {
    throw table.error(
        fmt::format("needs 'poissons_ratio' of material '{}' for the Timoshenko theory", material.name));
  }
  if (std::isnan(geometry.shear_coefficient)) {
    throw table.error("needs 'shear_coefficient' for the Timoshenko theory, or a 'shape'");
  }
  return geometry.shear_coefficient * fem::calc_shear_modulus(material) * geometry.area;
}

// The keys that every section has, and those of its shape.
void expect_section_keys(const TomlTable& table) {
  for (const char* key : {"material", "mass_per_length", "shear_coefficient", "count", "shape"}) {
    static_cast<void>(table.has(key));
  }
  const auto value = table.find("shape");
  const std::string shape = value ? value->one_of(kShapes) : "";
  if (shape.empty()) expect_keys(table, {"area", "second_moment", "section_modulus"});
  if (shape == "rectangle") expect_keys(table, {"width", "height"});
  if (shape == "box") expect_keys(table, {"width", "height", "wall"});
  if (shape == "tube") expect_keys(table, {"outer_diameter", "wall"});
  if (shape == "i_section")
    expect_keys(table, {"height", "flange_width", "flange_thickness", "web_thickness"});
}

fem::BeamProperties read_section(const TomlTable& table, const Materials& materials,
                                 const BeamTheory& theory) {
  expect_section_keys(table);
  const fem::Material& material = find_material(table, materials);
  const fem::SectionGeometry geometry = read_geometry(table, material);
  const double mass_per_length = read_mass_per_length(table, material, geometry.area);
  const auto count = static_cast<double>(table.integer_or("count", 1, 1, 1000));
  fem::BeamProperties properties{.axial_rigidity = count * material.youngs_modulus * geometry.area,
                                 .bending_rigidity = count * material.youngs_modulus * geometry.second_moment,
                                 .mass_per_length = count * mass_per_length,
                                 .area = count * geometry.area,
                                 .section_modulus = count * geometry.section_modulus};
  if (theory.shear_deformation)
    properties.shear_rigidity = count * calc_shear_rigidity(table, material, geometry);
  if (theory.rotary_inertia) {
    properties.rotary_inertia = count * mass_per_length * geometry.second_moment / geometry.area;
  }
  return properties;
}

}  // namespace

BeamTheory read_beam_theory(const TomlTable& root) {
  static const std::array<std::string, 2> kTheories{"euler-bernoulli", "timoshenko"};
  BeamTheory theory;
  if (const auto name = root.find("theory"))
    theory.shear_deformation = name->one_of(kTheories) == "timoshenko";
  theory.rotary_inertia = root.boolean_or("rotary_inertia", false);
  return theory;
}

Materials read_materials(const TomlTable& root) {
  Materials materials;
  for (const auto& [name, value] : root.at("materials").table().entries()) {
    materials.emplace(name, read_material(name, value.table()));
  }
  return materials;
}

Sections read_sections(const TomlTable& root, const Materials& materials, const BeamTheory& theory) {
  Sections sections;
  for (const auto& [name, value] : root.at("sections").table().entries()) {
    sections.emplace(name, read_section(value.table(), materials, theory));
  }
  return sections;
}

}  // namespace sprung::reduce

#include "reduce/design/design_sections.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "fem/section_shapes.h"
#include "fem/spring.h"
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

// The table of a section, or of what lies between two: every number is interpolated linearly.
class SectionTable {
 public:
  explicit SectionTable(const TomlTable& only) : first_(only) {}
  /// @param share  0 … 1, of the way to the second one
  SectionTable(const TomlTable& first, const TomlTable& second, double share)
      : first_(first), second_(second), share_(share) {}

  const TomlTable& table() const { return first_; }
  bool has(std::string_view key) const { return first_.has(key); }
  double size(std::string_view key, std::string_view unit, const SizeRange& range) const {
    const double first = read_size(first_, key, unit, range);
    return second_ ? (1.0 - share_) * first + share_ * read_size(*second_, key, unit, range) : first;
  }

 private:
  TomlTable first_;
  std::optional<TomlTable> second_ = {};
  double share_ = 0.0;
};

const fem::Material& find_material(const TomlTable& section, const Materials& materials) {
  const TomlValue name = section.at("material");
  const auto found = materials.find(name.string());
  if (found != materials.end()) return found->second;
  throw name.error(fmt::format("names the material '{}', which is not defined{}", name.string(),
                               support::nearest_name_hint(name.string(), get_names(materials))));
}

fem::SectionGeometry calc_shape(const std::string& shape, const SectionTable& table, double poissons_ratio) {
  const auto length = [&](const char* key) { return table.size(key, "m", kLengths); };
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
fem::SectionGeometry read_geometry(const SectionTable& table, const fem::Material& material) {
  fem::SectionGeometry geometry;
  if (const auto shape = table.table().find("shape")) {
    // Only the shear coefficient depends on Poisson's ratio, and it is not used without one.
    const double poissons_ratio = std::isnan(material.poissons_ratio) ? 0.0 : material.poissons_ratio;
    try {
      geometry = calc_shape(shape->one_of(kShapes), table, poissons_ratio);
    } catch (const std::invalid_argument& fault) {
      const std::string_view what = fault.what();  // "function: what was found and expected"
      throw table.table().error(fmt::format("is no possible section: {}", what.substr(what.find(": ") + 2)));
    }
    if (!(geometry.area > 0.0 && geometry.second_moment > 0.0)) {
      throw table.table().error(
          fmt::format("has the area {:.3g} m² and the second moment {:.3g} m⁴: rounding leaves "
                      "nothing of walls as thin as these",
                      geometry.area, geometry.second_moment));
    }
  } else {
    geometry = {.area = table.size("area", "m²", kAreas),
                .second_moment = table.size("second_moment", "m⁴", kSecondMoments),
                .shear_coefficient = std::numeric_limits<double>::quiet_NaN()};
    if (table.has("section_modulus"))
      geometry.section_modulus = table.size("section_modulus", "m³", kSectionModuli);
  }
  if (table.has("shear_coefficient")) {
    geometry.shear_coefficient = table.size("shear_coefficient", "", kShearCoefficients);
  }
  return geometry;
}

double read_mass_per_length(const SectionTable& table, const fem::Material& material, double area) {
  if (table.has("mass_per_length")) return table.size("mass_per_length", "kg/m", kMassesPerLength);
  if (material.density > 0.0) return material.density * area;
  throw table.table().error(
      fmt::format("needs 'mass_per_length', because material '{}' has no 'density'", material.name));
}

double calc_shear_rigidity(const SectionTable& table, const fem::Material& material,
                           const fem::SectionGeometry& geometry) {
  if (std::isnan(material.poissons_ratio)) {
    throw table.table().error(
        fmt::format("needs 'poissons_ratio' of material '{}' for the Timoshenko theory", material.name));
  }
  if (std::isnan(geometry.shear_coefficient)) {
    throw table.table().error("needs 'shear_coefficient' for the Timoshenko theory, or a 'shape'");
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

fem::BeamProperties calc_properties(const SectionTable& table, const Materials& materials,
                                    const BeamTheory& theory) {
  expect_section_keys(table.table());
  const fem::Material& material = find_material(table.table(), materials);
  const fem::SectionGeometry geometry = read_geometry(table, material);
  const double mass_per_length = read_mass_per_length(table, material, geometry.area);
  const auto count = static_cast<double>(table.table().integer_or("count", 1, 1, 1000));
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

// What must be the same at both ends of a tapered line: which keys there are, and all that is no length.
void check_same_kind(const TomlValue& taper, const TomlTable& first, const TomlTable& second) {
  const auto get_keys = [](const TomlTable& table) {
    std::set<std::string> keys;
    for (const auto& [key, value] : table.entries()) keys.insert(key);
    return keys;
  };
  if (get_keys(first) != get_keys(second))
    throw taper.error("names two sections with different keys; give both by the same ones");
  for (const char* key : {"material", "shape"}) {
    if (first.has(key) && first.at(key).string() != second.at(key).string())
      throw taper.error(fmt::format("names two sections with different '{}'", key));
  }
  if (first.integer_or("count", 1, 1, 1000) != second.integer_or("count", 1, 1, 1000))
    throw taper.error("names two sections with different 'count'");
}

TomlTable find_section_table(const TomlTable& sections, const TomlValue& name) {
  std::vector<std::string> names;
  for (const auto& [known, value] : sections.entries()) {
    if (known == name.string()) return value.table();
    names.push_back(known);
  }
  throw name.error(fmt::format("names the section '{}', which is not defined{}", name.string(),
                               support::nearest_name_hint(name.string(), names)));
}

// The section of an element, made for a table. Its name may be that of no other.
void add_section(const TomlTable& table, const std::string& name, const fem::BeamProperties& properties,
                 Sections& sections) {
  if (!sections.emplace(name, properties).second)
    throw table.error(
        fmt::format("has a section that is called '{}', as one under [sections]; rename that", name));
}

// The sections of a tapered line's elements, each that of its middle.
void add_tapered_sections(const TomlTable& line, const TomlTable& tables, const Materials& materials,
                          const BeamTheory& theory, Sections& sections) {
  const std::optional<TaperedLine> taper = find_taper(line);
  if (!taper) return;
  const TomlValue ends = line.at("section");
  const TomlTable first = find_section_table(tables, ends.items()[0]),
                  second = find_section_table(tables, ends.items()[1]);
  check_same_kind(ends, first, second);
  for (int element = 0; element < taper->num_elements; ++element) {
    const double share = (element + 0.5) / taper->num_elements;
    add_section(line, taper->section_name(element),
                calc_properties(SectionTable(first, second, share), materials, theory), sections);
  }
}

Eigen::Vector2d find_place(const TomlTable& root, const TomlValue& name) {
  std::vector<std::string> names;
  for (const auto& [known, value] : root.at("points").table().entries()) {
    if (known == name.string()) {
      const std::vector<double> place = value.numbers(support::any("m"), 2);
      return {place[0], place[1]};
    }
    names.push_back(known);
  }
  throw name.error(fmt::format("names the point '{}', which is not defined{}", name.string(),
                               support::nearest_name_hint(name.string(), names)));
}

fem::BeamProperties read_spring(const TomlTable& root, const TomlTable& table) {
  expect_keys(table, {"from", "to", "axial_stiffness", "transverse_stiffness", "rotational_stiffness"});
  const double length = (find_place(root, table.at("to")) - find_place(root, table.at("from"))).norm();
  if (!(length > 0.0)) throw table.at("to").error("is at the place of 'from'");
  fem::Spring spring{.axial = read_size(table, "axial_stiffness", "N/m", kStiffnesses),
                     .rotational = read_size(table, "rotational_stiffness", "N·m", kStiffnesses)};
  const double largest = fem::calc_largest_transverse_stiffness(spring.rotational, length);
  spring.transverse = largest;
  if (const auto given = table.find("transverse_stiffness")) {
    spring.transverse = read_size(table, "transverse_stiffness", "N/m", kStiffnesses);
    if (spring.transverse > largest) {
      throw given->error(
          fmt::format("is {:.6g} N/m, expected at most 12 rotational_stiffness / length² = "
                      "{:.6g} N/m, the stiffness of a bushing in the middle",
                      spring.transverse, largest));
    }
  }
  return fem::make_spring_properties(spring, length);
}

}  // namespace

std::string name_spring_section(const TomlTable& spring) {
  return spring.key();
}

std::string TaperedLine::section_name(int element) const {
  return fmt::format("{}, element {} of {}", key, element + 1, num_elements);
}

std::optional<TaperedLine> find_taper(const TomlTable& line) {
  const auto section = line.find("section");
  if (!section || !section->is_array()) return std::nullopt;
  const std::vector<TomlValue> ends = section->items();
  if (ends.size() != 2) {
    throw section->error(
        fmt::format("names {} sections, expected one, or those at both ends of a tapered line", ends.size()));
  }
  if (line.has("through"))
    throw section->error("names two sections: a tapered line has 'from' and 'to' in place of 'through'");
  return TaperedLine{.key = line.key(),
                     .num_elements = static_cast<int>(line.at("elements").integer(1, kMostElements))};
}

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
    sections.emplace(name, calc_properties(SectionTable(value.table()), materials, theory));
  }
  if (const auto lines = root.find("lines")) {
    const TomlTable tables = root.at("sections").table();
    for (const TomlValue& line : lines->items())
      add_tapered_sections(line.table(), tables, materials, theory, sections);
  }
  if (const auto springs = root.find("springs")) {
    for (const TomlValue& item : springs->items()) {
      const TomlTable spring = item.table();
      add_section(spring, name_spring_section(spring), read_spring(root, spring), sections);
    }
  }
  return sections;
}

}  // namespace sprung::reduce

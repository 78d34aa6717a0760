#include "reduce/design/design_parameters.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "reduce/design/design_frame.h"
#include "reduce/design/design_sections.h"

namespace sprung::reduce {

namespace {

using support::InputError;
using support::TomlDocument;
using support::TomlTable;
using support::TomlValue;

constexpr double kStep = 1e-3;  // of a number, or of the frame's extent

struct Number {
  std::string key, unit;
  double value;
};

std::string find_unit(const std::string& name) {
  if (name == "youngs_modulus") return "Pa";
  if (name == "density") return "kg/m³";
  if (name == "area") return "m²";
  if (name == "second_moment") return "m⁴";
  if (name == "mass_per_length") return "kg/m";
  if (name == "poissons_ratio" || name == "shear_coefficient") return "";
  return "m";
}

// Numbers of the tables in [materials] or [sections]; `count` is a whole number, and no parameter.
void list_numbers(const TomlTable& root, const char* name, std::vector<Number>& numbers) {
  for (const auto& [item, table] : root.at(name).table().entries()) {
    for (const auto& [key, value] : table.table().entries()) {
      if (!value.is_number() || key == "count") continue;
      numbers.push_back({value.key(), find_unit(key), value.number(support::any(""))});
    }
  }
}

class DesignVariation {
 public:
  DesignVariation(const DesignSource& source, const Design& design) : source_(source), design_(design) {}

  // Each section's properties with a number changed.
  std::vector<fem::BeamProperties> read_changed_sections(const Number& number, double value) const {
    const TomlDocument changed = change(number, value);
    const TomlTable root = changed.root();
    const Sections sections = read_sections(root, read_materials(root), read_beam_theory(root));
    std::vector<fem::BeamProperties> properties;
    for (const std::string& name : design_.model.mesh.section_names) properties.push_back(sections.at(name));
    return properties;
  }

  // The nodes with a coordinate changed. None if they are other nodes, or the point lies on no node then.
  std::optional<Eigen::Matrix2Xd> read_changed_nodes(const Number& number, double value) const {
    const TomlDocument changed = change(number, value);
    const TomlTable root = changed.root();
    try {
      const Sections sections = read_sections(root, read_materials(root), read_beam_theory(root));
      const fem::Mesh mesh = read_design_frame(root, source_.path.parent_path(), sections).mesh;
      if (mesh.node_ids != design_.model.mesh.node_ids) return std::nullopt;
      return mesh.node_positions;
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  fem::BeamModelRates make_rates() const {
    return {.node_positions = Eigen::Matrix2Xd::Zero(2, design_.model.mesh.num_nodes()),
            .sections = std::vector<fem::BeamPropertyRates>(design_.model.sections.size()),
            .point_masses =
                std::vector<Eigen::Vector2d>(design_.model.point_masses.size(), Eigen::Vector2d::Zero())};
  }

 private:
  TomlDocument change(const Number& number, double value) const {
    DesignSource changed = source_;
    changed.overrides.push_back(fmt::format("{}={:.17g}", number.key, value));
    return read_document(changed);
  }

  const DesignSource& source_;
  const Design& design_;
};

// f'(x) by f(x ± h), f(x ± 2h), in this order: exact for polynomials of the fourth degree.
double calc_derivative(const std::array<double, 4>& f, double h) {
  return (8.0 * (f[0] - f[1]) - (f[2] - f[3])) / (12.0 * h);
}

// None at the end of a range, where a section is no section any more.
std::optional<fem::BeamModelRates> calc_section_rates(const DesignVariation& variation,
                                                      const Number& number) {
  const double h = kStep * (number.value == 0.0 ? 1.0 : std::abs(number.value));
  std::vector<std::vector<fem::BeamProperties>> at;
  try {
    for (const double step : {h, -h, 2.0 * h, -2.0 * h})
      at.push_back(variation.read_changed_sections(number, number.value + step));
  } catch (const InputError&) {
    return std::nullopt;
  }
  fem::BeamModelRates rates = variation.make_rates();
  double largest = 0.0;
  for (std::size_t i = 0; i < rates.sections.size(); ++i) {
    const auto derive = [&](double fem::BeamProperties::*member) {
      if (std::isinf(at[0][i].*member)) return 0.0;
      const double rate =
          calc_derivative({at[0][i].*member, at[1][i].*member, at[2][i].*member, at[3][i].*member}, h);
      if (std::abs(rate) * h < 1e-12 * std::abs(at[0][i].*member)) return 0.0;  // rounding
      largest = std::max(largest, std::abs(rate));
      return rate;
    };
    rates.sections[i] = {.axial_rigidity = derive(&fem::BeamProperties::axial_rigidity),
                         .bending_rigidity = derive(&fem::BeamProperties::bending_rigidity),
                         .shear_rigidity = derive(&fem::BeamProperties::shear_rigidity),
                         .mass_per_length = derive(&fem::BeamProperties::mass_per_length),
                         .rotary_inertia = derive(&fem::BeamProperties::rotary_inertia)};
  }
  if (largest == 0.0) return std::nullopt;
  return rates;
}

void add_section_parameters(const DesignVariation& variation, const TomlTable& root,
                            std::vector<DesignParameter>& parameters) {
  std::vector<Number> numbers;
  list_numbers(root, "materials", numbers);
  list_numbers(root, "sections", numbers);
  for (const Number& number : numbers) {
    if (auto rates = calc_section_rates(variation, number)) {
      parameters.push_back(
          {.key = number.key, .value = number.value, .unit = number.unit, .rates = std::move(*rates)});
    }
  }
}

// Of the points that lines end at; those of a mesh file are no numbers of the design.
void add_coordinates(const DesignVariation& variation, const TomlTable& root, const fem::Mesh& mesh,
                     std::vector<DesignParameter>& parameters) {
  if (root.has("mesh")) return;
  const double h =
      kStep * (mesh.node_positions.rowwise().maxCoeff() - mesh.node_positions.rowwise().minCoeff()).norm();
  for (const auto& [name, point] : root.at("points").table().entries()) {
    for (const TomlValue& coordinate : point.items()) {
      const Number number{coordinate.key(), "m", coordinate.number(support::any("m"))};
      const auto up = variation.read_changed_nodes(number, number.value + h);
      const auto down = up ? variation.read_changed_nodes(number, number.value - h) : std::nullopt;
      if (!up || !down) continue;
      fem::BeamModelRates rates = variation.make_rates();
      rates.node_positions = (*up - *down) / (2.0 * h);
      parameters.push_back({.key = number.key,
                            .value = number.value,
                            .unit = number.unit,
                            .is_coordinate = true,
                            .rates = std::move(rates)});
    }
  }
}

void add_point_masses(const DesignVariation& variation, const TomlTable& root,
                      std::vector<DesignParameter>& parameters) {
  const auto masses = root.find("point_masses");
  if (!masses) return;
  std::size_t i = 0;
  for (const TomlValue& item : masses->items()) {
    for (const auto& [name, row, unit] : {std::tuple{"mass", 0, "kg"}, std::tuple{"inertia", 1, "kg·m²"}}) {
      const auto value = item.table().find(name);
      if (!value) continue;
      fem::BeamModelRates rates = variation.make_rates();
      rates.point_masses[i](row) = 1.0;
      parameters.push_back({.key = value->key(),
                            .value = value->number(support::any(unit)),
                            .unit = unit,
                            .rates = std::move(rates)});
    }
    ++i;
  }
}

}  // namespace

std::vector<DesignParameter> list_parameters(const DesignSource& source, const Design& design) {
  const TomlDocument document = read_document(source);
  const TomlTable root = document.root();
  const DesignVariation variation(source, design);
  std::vector<DesignParameter> parameters;
  add_section_parameters(variation, root, parameters);
  add_coordinates(variation, root, design.model.mesh, parameters);
  add_point_masses(variation, root, parameters);
  return parameters;
}

}  // namespace sprung::reduce

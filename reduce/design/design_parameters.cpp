#include "reduce/design/design_parameters.h"

#include <fmt/format.h>

#include <algorithm>
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

constexpr const char* kNoDerivatives =
    "stands in a design whose derivatives are not computed; take 'sprung-reduce sweep'";
constexpr double kStep = 1e-3;            // of a number
constexpr double kCoordinateStep = 1e-4;  // of the frame's extent, small beside the length of a short spring

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
  if (name == "axial_stiffness" || name == "transverse_stiffness") return "N/m";
  if (name == "rotational_stiffness") return "N·m";
  if (name == "poissons_ratio" || name == "shear_coefficient") return "";
  return "m";
}

// Numbers of a table. `count` is a whole number, and no parameter; on the section modulus no frequency
// depends.
void list_numbers(const TomlTable& table, std::vector<Number>& numbers) {
  for (const auto& [key, value] : table.entries()) {
    if (!value.is_number() || key == "count" || key == "section_modulus") continue;
    numbers.push_back({value.key(), find_unit(key), value.number(support::any(""))});
  }
}

// The frame of a design with a number changed.
class DesignVariation {
 public:
  DesignVariation(const DesignSource& source, const Design& design) : source_(source), design_(design) {}

  fem::BeamModel read_changed_sections(const Number& number, double value) const {
    const TomlDocument changed = read_document(change(number, value));
    const TomlTable root = changed.root();
    const Sections sections = read_sections(root, read_materials(root), read_beam_theory(root));
    return make_model_with(sections);
  }

  fem::BeamModel read_changed_nodes(const Number& number, double value) const {
    const TomlDocument changed = read_document(change(number, value));
    const TomlTable root = changed.root();
    const Sections sections = read_sections(root, read_materials(root), read_beam_theory(root));
    fem::BeamModel model = make_model_with(sections);  // springs depend on their lengths
    model.mesh.node_positions =
        read_design_frame(root, source_.path.parent_path(), sections).mesh.node_positions;
    return model;
  }

  fem::BeamModel read_changed_model(const Number& number, double value) const {
    return read_design(change(number, value)).model;
  }

  fem::BeamModelRates make_rates() const {
    return {.node_positions = Eigen::Matrix2Xd::Zero(2, design_.model.mesh.num_nodes()),
            .sections = std::vector<fem::BeamPropertyRates>(design_.model.sections.size()),
            .point_masses =
                std::vector<Eigen::Vector2d>(design_.model.point_masses.size(), Eigen::Vector2d::Zero())};
  }

 private:
  fem::BeamModel make_model_with(const Sections& sections) const {
    fem::BeamModel model = design_.model;
    for (std::size_t i = 0; i < model.sections.size(); ++i)
      model.sections[i] = sections.at(model.mesh.section_names[i]);
    return model;
  }
  DesignSource change(const Number& number, double value) const {
    DesignSource changed = source_;
    changed.overrides.push_back(fmt::format("{}={:.17g}", number.key, value));
    return changed;
  }

  const DesignSource& source_;
  const Design& design_;
};

using ModelReader = fem::BeamModel (DesignVariation::*)(const Number&, double) const;

// f'(x) by f(x ± h), f(x ± 2h), in this order: exact for polynomials of the fourth degree. What is rounding
// counts as 0.
double calc_derivative(const std::array<double, 4>& f, double h, double scale) {
  if (std::isinf(f[0])) return 0.0;
  const double change = (8.0 * (f[0] - f[1]) - (f[2] - f[3])) / 12.0;
  return std::abs(change) <= 1e-12 * scale ? 0.0 : change / h;
}

// None without effect, with other nodes, or at the end of a range, where there is no such design any more.
std::optional<fem::BeamModelRates> calc_rates(const DesignVariation& variation, ModelReader read,
                                              const Number& number, double h, std::string& reason) {
  std::vector<fem::BeamModel> at;
  fem::BeamModelRates rates = variation.make_rates();
  try {
    for (const double step : {h, -h, 2.0 * h, -2.0 * h}) {
      at.push_back((variation.*read)(number, number.value + step));
      if (at.back().mesh.num_nodes() == rates.node_positions.cols()) continue;
      reason = "another point is at its place or on its line, and stays behind when it moves";
      return std::nullopt;
    }
  } catch (const InputError& error) {
    reason = fmt::format("there is no such design any more where it changes ({})", error.what());
    return std::nullopt;
  }
  double largest = 0.0;
  const auto derive = [&](const auto& value, double scale) {
    const double rate = calc_derivative({value(at[0]), value(at[1]), value(at[2]), value(at[3])}, h, scale);
    largest = std::max(largest, std::abs(rate));
    return rate;
  };
  for (std::size_t i = 0; i < rates.sections.size(); ++i) {
    const auto derive_member = [&](double fem::BeamProperties::*member) {
      const auto value = [&](const fem::BeamModel& model) { return model.sections[i].*member; };
      return derive(value, std::abs(value(at[0])));
    };
    rates.sections[i] = {.axial_rigidity = derive_member(&fem::BeamProperties::axial_rigidity),
                         .bending_rigidity = derive_member(&fem::BeamProperties::bending_rigidity),
                         .shear_rigidity = derive_member(&fem::BeamProperties::shear_rigidity),
                         .mass_per_length = derive_member(&fem::BeamProperties::mass_per_length),
                         .rotary_inertia = derive_member(&fem::BeamProperties::rotary_inertia)};
  }
  const double extent = fem::calc_extent(at[0].mesh);
  for (Eigen::Index i = 0; i < rates.node_positions.size(); ++i) {
    rates.node_positions(i) =
        derive([&](const fem::BeamModel& model) { return model.mesh.node_positions(i); }, extent);
  }
  for (std::size_t i = 0; i < rates.point_masses.size(); ++i) {
    const fem::PointMass& one = at[0].point_masses[i];
    rates.point_masses[i] << derive([&](const fem::BeamModel& m) { return m.point_masses[i].mass; },
                                    one.mass),
        derive([&](const fem::BeamModel& m) { return m.point_masses[i].inertia; }, one.inertia);
  }
  if (largest == 0.0) return std::nullopt;
  return rates;
}

struct Listed {
  std::vector<DesignParameter> parameters;
  std::vector<LeftOutNumber> left_out;
};

void add_parameter(const DesignVariation& variation, ModelReader read, const Number& number, double h,
                   Listed& listed) {
  std::string reason;
  auto rates = calc_rates(variation, read, number, h, reason);
  if (!rates) {
    if (!reason.empty()) listed.left_out.push_back({.key = number.key, .reason = reason});
    return;
  }
  listed.parameters.push_back({.key = number.key,
                               .value = number.value,
                               .unit = number.unit,
                               .is_coordinate = read == &DesignVariation::read_changed_nodes,
                               .rates = std::move(*rates)});
}

double choose_difference(double value) {
  return kStep * (value == 0.0 ? 1.0 : std::abs(value));
}

// Of [parameters], which may change anything; of materials, sections and springs.
void add_numbers(const DesignVariation& variation, const TomlTable& root, Listed& listed) {
  if (const auto table = root.find_table("parameters")) {
    for (const auto& [name, value] : table->entries()) {
      const Number number{value.key(), "", value.number(support::any(""))};
      add_parameter(variation, &DesignVariation::read_changed_model, number, choose_difference(number.value),
                    listed);
    }
  }
  std::vector<Number> numbers;
  for (const char* name : {"materials", "sections"}) {
    for (const auto& [item, table] : root.at(name).table().entries()) list_numbers(table.table(), numbers);
  }
  if (const auto springs = root.find("springs")) {
    for (const TomlValue& spring : springs->items()) list_numbers(spring.table(), numbers);
  }
  for (const Number& number : numbers) {
    add_parameter(variation, &DesignVariation::read_changed_sections, number, choose_difference(number.value),
                  listed);
  }
}

// Of the points that lines end at; those of a mesh file are no numbers of the design.
void add_coordinates(const DesignVariation& variation, const TomlTable& root, const fem::Mesh& mesh,
                     Listed& listed) {
  if (root.has("mesh")) return;
  for (const auto& [name, point] : root.at("points").table().entries()) {
    for (const TomlValue& coordinate : point.items()) {
      add_parameter(variation, &DesignVariation::read_changed_nodes,
                    {coordinate.key(), "m", coordinate.number(support::any("m"))},
                    kCoordinateStep * fem::calc_extent(mesh), listed);
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

std::vector<DesignParameter> list_parameters(const DesignSource& source, const Design& design,
                                             std::vector<LeftOutNumber>* left_out) {
  const TomlDocument document = read_document(source);
  const TomlTable root = document.root();
  for (const char* key : {"rigid_offsets", "averages", "foundations"}) {
    if (const auto found = root.find(key)) throw found->error(kNoDerivatives);
  }
  if (const auto lines = root.find("lines")) {
    for (const TomlValue& line : lines->items())
      if (const auto via = line.table().find("via")) throw via->error(kNoDerivatives);
  }
  const DesignVariation variation(source, design);
  Listed listed;
  add_numbers(variation, root, listed);
  add_coordinates(variation, root, design.model.mesh, listed);
  add_point_masses(variation, root, listed.parameters);
  if (left_out != nullptr) *left_out = std::move(listed.left_out);
  return std::move(listed.parameters);
}

}  // namespace sprung::reduce

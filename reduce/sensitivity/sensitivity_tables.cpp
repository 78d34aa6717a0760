#include "reduce/sensitivity/sensitivity_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/support/terminal/json.h"
#include "tools/support/terminal/text_table.h"

namespace sprung::reduce {

namespace {

using support::Json;
using support::TextTable;

constexpr double kCentimetre = 0.01;

std::string describe_step(const DesignParameter& parameter) {
  if (parameter.is_coordinate) return "1 cm";
  return parameter.value == 0.0 ? "1 " + parameter.unit : "1 %";
}

std::string format_freedom(const Design& design, std::size_t j) {
  const InterfaceFreedom& one = design.reduction.interface[j];
  return fmt::format("{} {}", design.model.mesh.named_nodes[static_cast<std::size_t>(one.point)].name,
                     freedom_name(one.freedom));
}

// In % of a quantity, by a step of a parameter.
std::string format_effect(double derivative, double value, double step) {
  return value == 0.0 ? "" : support::format_fixed(100.0 * derivative * step / value, 4);
}

std::vector<std::string> begin_row(const DesignParameter& parameter) {
  return {parameter.key, fmt::format("{:.6g} {}", parameter.value, parameter.unit), describe_step(parameter)};
}

std::string format_frequencies(const DesignSensitivity& sensitivity, const char* heading,
                               Eigen::VectorXd BodyQuantities::*member) {
  const Eigen::VectorXd& values = sensitivity.value.*member;
  std::vector<std::string> header{"parameter", "value", "by"};
  for (const double hz : values) header.push_back(fmt::format("{:.4f} Hz", hz));
  TextTable table(header);
  for (const ParameterSensitivity& one : sensitivity.parameters) {
    std::vector<std::string> row = begin_row(one.parameter);
    const double step = choose_step(one.parameter);
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      row.push_back(format_effect((one.derivative.*member)(i), values(i), step));
    }
    table.add_row(row);
  }
  return fmt::format("{}, change in %\n{}\n", heading, table.str());
}

// The interface freedom whose flexibility changes most, and by how much.
std::vector<std::string> format_largest(const Design& design, const BodyQuantities& value,
                                        const ParameterSensitivity& one, double step) {
  if (value.flexibility.size() == 0) return {"", ""};
  Eigen::Index worst = 0;
  const Eigen::VectorXd share = (value.flexibility.array() > 0.0)
                                    .select(one.derivative.flexibility.cwiseQuotient(value.flexibility), 0.0);
  share.cwiseAbs().maxCoeff(&worst);
  return {support::format_fixed(100.0 * share(worst) * step, 4),
          format_freedom(design, static_cast<std::size_t>(worst))};
}

// The largest share of the certificate, in % of it.
std::string format_certificate(const BodyQuantities& value, const BodyQuantities& derivative, double step) {
  if (value.certificate.size() == 0) return "";
  Eigen::Index worst = 0;
  const double largest = value.certificate.maxCoeff(&worst);
  return format_effect(derivative.certificate(worst), largest, step);
}

std::string name_certificate(const Design& design, const BodyQuantities& value) {
  if (value.certificate.size() == 0) return "certificate";
  Eigen::Index worst = 0;
  const double largest = value.certificate.maxCoeff(&worst);
  return fmt::format("certificate {:.2g} % ({})", 100.0 * largest,
                     format_freedom(design, static_cast<std::size_t>(worst)));
}

std::string format_others(const Design& design, const DesignSensitivity& sensitivity) {
  const BodyQuantities& value = sensitivity.value;
  TextTable table({"parameter", "value", "by", fmt::format("mass {:.6g} kg", value.mass),
                   fmt::format("inertia {:.6g} kg·m²", value.inertia), "flexibility, most", "of",
                   name_certificate(design, value)});
  for (const ParameterSensitivity& one : sensitivity.parameters) {
    std::vector<std::string> row = begin_row(one.parameter);
    const double step = choose_step(one.parameter);
    row.push_back(format_effect(one.derivative.mass, value.mass, step));
    row.push_back(format_effect(one.derivative.inertia, value.inertia, step));
    for (std::string& cell : format_largest(design, value, one, step)) row.push_back(std::move(cell));
    row.push_back(format_certificate(value, one.derivative, step));
    table.add_row(row);
  }
  return "Mass, inertia about the centre of mass, static flexibility of the interface, certificate, change "
         "in "
         "%\n" +
         table.str();
}

Json make_list(const Eigen::VectorXd& values) {
  return std::vector<double>(values.begin(), values.end());
}

Json make_quantities(const BodyQuantities& quantities) {
  return {{"free_frequency_hz", make_list(quantities.free_hz)},
          {"clamped_frequency_hz", make_list(quantities.clamped_hz)},
          {"mass_kg", quantities.mass},
          {"inertia_kg_m2", quantities.inertia},
          {"interface_flexibility", make_list(quantities.flexibility)},
          {"certificate", make_list(quantities.certificate)}};
}

Json make_elements(const fem::BeamModel& model, const ElementShares& shares) {
  Json items = Json::array();
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const fem::BeamElement element = fem::make_element(model, e);
    const auto section = static_cast<std::size_t>(model.mesh.elements[static_cast<std::size_t>(e)].section);
    items.push_back({{"section", model.mesh.section_names[section]},
                     {"from_m", {element.first.x(), element.first.y()}},
                     {"to_m", {element.second.x(), element.second.y()}},
                     {"strain_energy_share", make_list(shares.strain.row(e))},
                     {"kinetic_energy_share", make_list(shares.kinetic.row(e))}});
  }
  return items;
}

}  // namespace

double choose_step(const DesignParameter& parameter) {
  if (parameter.is_coordinate) return kCentimetre;
  return parameter.value == 0.0 ? 1.0 : 0.01 * parameter.value;
}

std::string format_sensitivity(const Design& design, const DesignSensitivity& sensitivity) {
  return format_frequencies(sensitivity, "Modes of the free body", &BodyQuantities::free_hz) +
         format_frequencies(sensitivity, "Modes of the body clamped at its reference node",
                            &BodyQuantities::clamped_hz) +
         format_others(design, sensitivity);
}

std::string format_left_out(const std::vector<LeftOutNumber>& left_out) {
  std::string text;
  for (const LeftOutNumber& one : left_out) text += fmt::format("{} is left out: {}\n", one.key, one.reason);
  return text.empty() ? text : "\n" + text;
}

std::string format_sensitivity_json(const Design& design, const DesignSensitivity& sensitivity,
                                    const std::vector<LeftOutNumber>& left_out) {
  Json interface = Json::array(), parameters = Json::array(), without = Json::array();
  for (const LeftOutNumber& one : left_out) without.push_back({{"key", one.key}, {"reason", one.reason}});
  for (std::size_t j = 0; j < design.reduction.interface.size(); ++j)
    interface.push_back(format_freedom(design, j));
  for (const ParameterSensitivity& one : sensitivity.parameters) {
    parameters.push_back({{"key", one.parameter.key},
                          {"value", one.parameter.value},
                          {"unit", one.parameter.unit},
                          {"derivative", make_quantities(one.derivative)}});
  }
  return support::format_json({{"name", design.name},
                               {"interface", interface},
                               {"value", make_quantities(sensitivity.value)},
                               {"parameters", parameters},
                               {"left_out", without},
                               {"elements", make_elements(design.model, sensitivity.shares)}});
}

}  // namespace sprung::reduce

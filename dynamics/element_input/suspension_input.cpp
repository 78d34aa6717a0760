#include "dynamics/element_input/suspension_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "dynamics/element_input/characteristic_input.h"
#include "dynamics/element_input/input_values.h"

namespace sprung::dynamics {

namespace {

// Resistance of an orifice over the overlap: { coefficient = c } or { table = [[δ, c], …] }.
PiecewisePolynomial read_metering(const support::TomlTable& table) {
  constexpr std::array<std::string_view, 2> kWays{"coefficient", "table"};
  const support::Quantity unit = support::non_negative("N·s²/m²");
  const std::string_view way = find_only_key(table, kWays, "either 'coefficient' or 'table'");
  if (way == "coefficient") {
    const double coefficient = table.number(way, unit);
    table.reject_unknown_keys();
    return PiecewisePolynomial({coefficient});
  }
  const support::TomlValue rows = table.at(way);
  table.reject_unknown_keys();
  const PointList points = read_point_list(rows, support::non_negative("m"), unit);
  if (points.x.front() != 0.0)
    throw rows.error(fmt::format("must begin at overlap 0, begins at {} m", points.x.front()));
  PiecewisePolynomial law = PiecewisePolynomial::through_points(points.x, points.y);
  if (!(law.slope(points.x.back()) >= 0.0))
    throw rows.error(
        "must not fall at its end, which goes on straight: the resistance would become negative");
  return law;
}

std::optional<Bushing::Direction> read_direction_laws(const support::TomlTable& bushing, std::string_view key,
                                                      const LawUnits& units) {
  const std::optional<support::TomlTable> table = bushing.find_table(key);
  if (!table) return std::nullopt;
  Bushing::Direction direction;
  const std::optional<support::TomlTable> spring = table->find_table("spring");
  const std::optional<support::TomlTable> damper = table->find_table("damper");
  if (spring) direction.spring = read_spring(*spring, units);
  if (damper) direction.damper = read_damper(*damper, units);
  const std::optional<support::TomlTable> relaxation = table->find_table("relaxation");
  if (relaxation) {
    direction.relaxing_stiffness = relaxation->number("stiffness", support::positive(units.stiffness));
    direction.relaxation_time = relaxation->number("time", support::positive("s"));
    relaxation->reject_unknown_keys();
  }
  table->reject_unknown_keys();
  if (!spring && !damper && !relaxation)
    throw table->error("must have a 'spring', a 'damper' or a 'relaxation'");
  return direction;
}

// Full friction over the deflection: { coefficient = F } or { table = [[d, F], …] }, which ends level.
PiecewisePolynomial read_friction(const support::TomlTable& table, double presliding_deflection) {
  constexpr std::array<std::string_view, 2> kWays{"coefficient", "table"};
  const std::string_view way = find_only_key(table, kWays, "either 'coefficient' or 'table'");
  const support::Quantity unit = support::positive("N");
  if (way == "coefficient") {
    const double force = table.number(way, unit);
    table.reject_unknown_keys();
    return PiecewisePolynomial({force});
  }
  const support::TomlValue rows = table.at(way);
  table.reject_unknown_keys();
  const PointList points = read_point_list(rows, support::any("m"), unit);
  for (std::size_t i = 1; i < points.x.size(); ++i) {
    const double change = std::abs(points.y[i] - points.y[i - 1]) / (points.x[i] - points.x[i - 1]);
    const double most = 2.0 * std::min(points.y[i], points.y[i - 1]) / presliding_deflection;
    if (change <= most) continue;
    throw rows.items()[i].error(
        fmt::format("changes by {:.4g} N/m from the point before; friction that builds up over {} m can "
                    "change by at most "
                    "{:.4g} N/m there, or it would put energy in",
                    change, presliding_deflection, most));
  }
  PiecewisePolynomial law = PiecewisePolynomial::through_points(points.x, points.y);
  law.continue_straight(points.x.back(), 0.0, false);
  law.continue_straight(points.x.front(), 0.0, true);
  return law;
}

}  // namespace

void read_hydraulic_stop(const support::TomlTable& table, ForceDescription& force,
                         HistoryFiles& /*histories*/) {
  force.points = {read_point(table.at("a")), read_point(table.at("b"))};
  force.along_line = true;
  HydraulicStop::Parameters parameters;
  parameters.contact_length = table.number("contact_length", support::positive("m"));
  parameters.damping = table.number_or("damping", 0.0, support::non_negative("N·s/m²"));
  const std::optional<support::TomlTable> spring = table.find_table("spring");
  if (spring) parameters.spring = read_spring(*spring);
  const std::optional<support::TomlTable> metering = table.find_table("metering");
  if (metering) parameters.metering = read_metering(*metering);
  if (!spring && !metering && parameters.damping == 0.0) {
    table.reject_unknown_keys();
    throw table.error("must have a 'spring', a 'metering' or a 'damping'");
  }
  force.parameters = std::move(parameters);
}

void read_bushing(const support::TomlTable& table, ForceDescription& force, HistoryFiles& /*histories*/) {
  force.points = {read_point(table.at("a")), read_point(table.at("b"))};
  Bushing::Parameters parameters;
  parameters.angle = table.number_or("angle", 0.0, support::any("rad"));
  if (const std::optional<support::TomlValue> position = table.find("free_position"))
    parameters.free_position = read_vector(*position, "m");
  parameters.free_angle = table.number_or("free_angle", 0.0, support::any("rad"));
  parameters.multiplicity = table.number_or("multiplicity", 1.0, kMultiplicity);
  constexpr std::array<std::string_view, 3> kKeys{"x", "y", "rotation"};
  bool has_direction = false;
  for (std::size_t k = 0; k < kKeys.size(); ++k) {
    const auto direction = read_direction_laws(table, kKeys[k], k == 2 ? kRotation : kTranslation);
    has_direction |= direction.has_value();
    if (direction) parameters.directions[k] = *direction;
  }
  if (!has_direction) {
    table.reject_unknown_keys();
    throw table.error("must have laws for at least one of 'x', 'y' and 'rotation'");
  }
  force.parameters = std::move(parameters);
}

void read_leaf_spring(const support::TomlTable& table, ForceDescription& force, HistoryFiles& /*histories*/) {
  force.points = {read_point(table.at("a")), read_point(table.at("b"))};
  force.along_line = true;
  LeafSpring::Parameters parameters;
  parameters.free_length = read_free_length(table, force);
  parameters.multiplicity = table.number_or("multiplicity", 1.0, kMultiplicity);
  parameters.spring = read_spring(table.at("spring").table());
  parameters.presliding_deflection = table.number("presliding_deflection", support::positive("m"));
  parameters.friction = read_friction(table.at("friction").table(), parameters.presliding_deflection);
  force.parameters = std::move(parameters);
}

}  // namespace sprung::dynamics

#include "reduce/inspection/superelement_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "reduce/inspection/superelement_tables.h"

namespace sprung::reduce {

namespace {

std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    if (static_cast<unsigned char>(letter) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
    } else {
      quoted += letter;
    }
  }
  return quoted + '"';
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

std::string list(const std::vector<std::string>& items) {
  return fmt::format("[{}]", fmt::join(items, ", "));
}

// @param members  key and value, the value in JSON already
std::string object(const std::vector<std::pair<std::string, std::string>>& members) {
  std::vector<std::string> items;
  for (const auto& [key, value] : members) items.push_back(quote(key) + ": " + value);
  return fmt::format("{{{}}}", fmt::join(items, ", "));
}

std::string format_modes_list(const Superelement& s) {
  const ModeKinds kinds = calc_mode_kinds(s);
  std::vector<std::string> items;
  for (Eigen::Index i = 0; i < s.num_modes(); ++i) {
    items.push_back(object({{"mode", fmt::format("{}", i + 1)},
                            {"frequency_hz", number(s.frequency_hz(i))},
                            {"damping_ratio", number(s.damping_ratio(i))},
                            {"cluster", fmt::format("{}", s.cluster(i))},
                            {"axial_energy_share", number(kinds.axial_share(i))},
                            {"effective_mass_x_share", number(kinds.effective_mass(0, i))},
                            {"effective_mass_y_share", number(kinds.effective_mass(1, i))},
                            {"effective_inertia_share", number(kinds.effective_mass(2, i))}}));
  }
  return list(items);
}

std::string format_points_list(const Superelement& s) {
  std::vector<std::string> items;
  for (const NamedPoint& point : s.points) {
    items.push_back(object({{"name", quote(point.name)},
                            {"node_id", fmt::format("{}", s.node_ids[static_cast<std::size_t>(point.node)])},
                            {"x_m", number(s.node_positions(0, point.node))},
                            {"y_m", number(s.node_positions(1, point.node))}}));
  }
  return list(items);
}

std::string format_checks_list(std::span<const CheckResult> checks) {
  std::vector<std::string> items;
  for (const CheckResult& check : checks) {
    items.push_back(object({{"name", quote(check.name)},
                            {"value", number(check.value)},
                            {"tolerance", number(check.tolerance)},
                            {"passed", check.passed() ? "true" : "false"}}));
  }
  return list(items);
}

std::string format_provenance(const Superelement& s) {
  std::vector<std::string> inputs;
  for (std::size_t i = 0; i < s.provenance.input_names.size(); ++i) {
    inputs.push_back(object(
        {{"name", quote(s.provenance.input_names[i])}, {"sha256", quote(s.provenance.input_hashes[i])}}));
  }
  return object({{"program_version", quote(s.provenance.program_version)},
                 {"algorithm_revision", fmt::format("{}", s.provenance.algorithm_revision)},
                 {"design_sha256", quote(s.provenance.design_hash)},
                 {"inputs", list(inputs)}});
}

std::string format_numbers(const ModeRange& range) {
  std::vector<std::string> items;
  for (Eigen::Index i = range.begin; i < range.end; ++i) items.push_back(fmt::format("{}", i + 1));
  return list(items);
}

}  // namespace

std::string format_superelement_json(const Superelement& s, std::span<const CheckResult> checks) {
  const Eigen::Vector2d center = s.inertia.first_moment / s.inertia.mass;
  const double central = s.inertia.second_moment - s.inertia.first_moment.squaredNorm() / s.inertia.mass;
  return object({{"name", quote(s.name)},
                 {"num_nodes", fmt::format("{}", s.num_nodes())},
                 {"num_elements", fmt::format("{}", s.elements.cols())},
                 {"num_elastic_dofs", fmt::format("{}", s.num_elastic_dofs)},
                 {"num_stiffened_modes",
                  fmt::format("{}", s.geometric_stiffness ? s.geometric_stiffness->num_modes() : 0)},
                 {"mass_kg", number(s.inertia.mass)},
                 {"center_of_mass_m", list({number(center.x()), number(center.y())})},
                 {"inertia_center_of_mass_kg_m2", number(central)},
                 {"inertia_reference_kg_m2", number(s.inertia.second_moment)},
                 {"modes", format_modes_list(s)},
                 {"points", format_points_list(s)},
                 {"checks", format_checks_list(checks)},
                 {"provenance", format_provenance(s)},
                 {"content_sha256", quote(s.content_hash)}}) +
         "\n";
}

std::string format_checks_json(const std::string& path, std::span<const CheckResult> checks) {
  return object({{"file", quote(path)}, {"checks", format_checks_list(checks)}}) + "\n";
}

std::string format_comparison_json(const Comparison& comparison) {
  std::vector<std::string> items;
  for (const ModeMatch& match : comparison.matches) {
    items.push_back(object({{"old_modes", format_numbers(match.old_modes)},
                            {"new_modes", format_numbers(match.new_modes)},
                            {"old_hz", match.old_modes.size() > 0 ? number(match.old_hz) : "null"},
                            {"new_hz", match.new_modes.size() > 0 ? number(match.new_hz) : "null"},
                            {"mac", number(match.mac)}}));
  }
  return object({{"comparable", comparison.comparable ? "true" : "false"}, {"modes", list(items)}}) + "\n";
}

}  // namespace sprung::reduce

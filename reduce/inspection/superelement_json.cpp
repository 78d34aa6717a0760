#include "reduce/inspection/superelement_json.h"

#include "reduce/inspection/superelement_tables.h"
#include "reduce/reduction/superelement_checks.h"
#include "tools/support/terminal/json.h"

namespace sprung::reduce {

using support::Json;

namespace {

Json make_modes_list(const Superelement& s) {
  const ModeKinds kinds = calc_mode_kinds(s);
  Json items = Json::array();
  for (Eigen::Index i = 0; i < s.num_modes(); ++i) {
    items.push_back({{"mode", i + 1},
                     {"vector", s.kind_of(static_cast<int>(i))},
                     {"frequency_hz", s.frequency_hz(i)},
                     {"damping_ratio", s.damping_ratio(i)},
                     {"cluster", s.cluster(i)},
                     {"axial_energy_share", kinds.axial_share(i)},
                     {"effective_mass_x_share", kinds.effective_mass(0, i)},
                     {"effective_mass_y_share", kinds.effective_mass(1, i)},
                     {"effective_inertia_share", kinds.effective_mass(2, i)}});
  }
  return items;
}

Json make_points_list(const Superelement& s) {
  Json items = Json::array();
  for (const NamedPoint& point : s.points) {
    items.push_back({{"name", point.name},
                     {"node_id", s.node_ids[static_cast<std::size_t>(point.node)]},
                     {"x_m", s.node_positions(0, point.node)},
                     {"y_m", s.node_positions(1, point.node)}});
  }
  return items;
}

// null stands for an error or a tolerance without bound, and for a frequency that there is not.
Json make_share(double share) {
  return share >= kUnbounded ? Json() : Json(share);
}

Json make_checks_list(std::span<const CheckResult> checks) {
  Json items = Json::array();
  for (const CheckResult& check : checks) {
    items.push_back({{"name", check.name},
                     {"value", check.value},
                     {"tolerance", check.tolerance < kNoTolerance ? Json(check.tolerance) : Json()},
                     {"passed", check.passed()}});
  }
  return items;
}

Json make_certificate(const Superelement& s) {
  if (!s.certificate) return {};
  const Certificate& certificate = *s.certificate;
  Json modes = Json::array(), interface = Json::array();
  for (Eigen::Index i = 0; i < certificate.free_hz.size(); ++i) {
    modes.push_back(
        {{"frequency_hz", certificate.free_hz(i)}, {"error", make_share(certificate.free_error(i))}});
  }
  for (const InterfaceError& one : certificate.interface) {
    interface.push_back({{"point", s.points[static_cast<std::size_t>(one.point)].name},
                         {"freedom", freedom_name(one.freedom)},
                         {"static_flexibility", one.static_flexibility},
                         {"static_error", one.static_error},
                         {"error", make_share(one.error)},
                         {"worst_hz", one.error >= kUnbounded ? Json() : Json(one.worst_hz)}});
  }
  return {{"highest_hz", certificate.highest_hz},
          {"tolerance", certificate.tolerance},
          {"cutoff_hz", certificate.cutoff_hz > 0.0 ? Json(certificate.cutoff_hz) : Json()},
          {"rounding_floor", certificate.rounding_floor},
          {"error", make_share(certificate.largest_error())},
          {"free_modes", modes},
          {"interface", interface}};
}

Json make_provenance(const Superelement& s) {
  Json inputs = Json::array();
  for (std::size_t i = 0; i < s.provenance.input_names.size(); ++i) {
    inputs.push_back({{"name", s.provenance.input_names[i]}, {"sha256", s.provenance.input_hashes[i]}});
  }
  return {{"program_version", s.provenance.program_version},
          {"algorithm_revision", s.provenance.algorithm_revision},
          {"design_sha256", s.provenance.design_hash},
          {"inputs", inputs}};
}

Json make_numbers(const ModeRange& range) {
  Json items = Json::array();
  for (Eigen::Index i = range.begin; i < range.end; ++i) items.push_back(i + 1);
  return items;
}

}  // namespace

std::string format_superelement_json(const Superelement& s, std::span<const CheckResult> checks) {
  const Eigen::Vector2d center = s.inertia.first_moment / s.inertia.mass;
  const double central = s.inertia.second_moment - s.inertia.first_moment.squaredNorm() / s.inertia.mass;
  return support::format_json(
      {{"name", s.name},
       {"num_nodes", s.num_nodes()},
       {"num_elements", s.elements.cols()},
       {"num_elastic_dofs", s.num_elastic_dofs},
       {"num_stiffened_modes", s.geometric_stiffness ? s.geometric_stiffness->num_modes() : 0},
       {"has_section_loads", s.section_loads.has_value()},
       {"num_elements_with_section_modulus", count_sized_elements(s)},
       {"mass_kg", s.inertia.mass},
       {"center_of_mass_m", {center.x(), center.y()}},
       {"inertia_center_of_mass_kg_m2", central},
       {"inertia_reference_kg_m2", s.inertia.second_moment},
       {"modes", make_modes_list(s)},
       {"points", make_points_list(s)},
       {"certificate", make_certificate(s)},
       {"checks", make_checks_list(checks)},
       {"provenance", make_provenance(s)},
       {"content_sha256", s.content_hash}});
}

std::string format_checks_json(const std::string& path, std::span<const CheckResult> checks) {
  return support::format_json({{"file", path}, {"checks", make_checks_list(checks)}});
}

std::string format_comparison_json(const Comparison& comparison) {
  Json items = Json::array();
  for (const ModeMatch& match : comparison.matches) {
    items.push_back({{"old_modes", make_numbers(match.old_modes)},
                     {"new_modes", make_numbers(match.new_modes)},
                     {"old_hz", match.old_modes.size() > 0 ? Json(match.old_hz) : Json()},
                     {"new_hz", match.new_modes.size() > 0 ? Json(match.new_hz) : Json()},
                     {"mac", match.mac}});
  }
  return support::format_json({{"comparable", comparison.comparable},
                               {"modes", items},
                               {"num_other_old", comparison.num_other_old},
                               {"num_other_new", comparison.num_other_new}});
}

}  // namespace sprung::reduce

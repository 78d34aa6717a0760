#include "reduce/inspection/superelement_tables.h"
#include "reduce/reduction/superelement_checks.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "reduce/reduction/element_work.h"
#include "tools/support/terminal/text_table.h"

namespace sprung::reduce {

namespace {

using support::TextTable;

std::string format_percent(double share) {
  return std::isnan(share) ? "–" : fmt::format("{:.1f}", 100.0 * share);
}

// Signed percent; what rounds to zero has no sign.
std::string format_change(double share) {
  const std::string text = fmt::format("{:+.3f}", 100.0 * share);
  return text == "-0.000" || text == "+0.000" ? "0.000" : text;
}

std::string format_kind(double axial_share) {
  if (std::isnan(axial_share)) return "–";  // a body from matrices has no beams
  if (axial_share > 0.95) return "axial";
  if (axial_share < 0.05) return "bending";
  return "mixed";
}

// "1–2", "3", or a dash for none.
std::string format_range(const ModeRange& range) {
  if (range.size() == 0) return "–";
  if (range.size() == 1) return fmt::format("{}", range.end);
  return fmt::format("{}–{}", range.begin + 1, range.end);
}

std::string format_frequency(const ModeRange& range, double frequency_hz) {
  return range.size() == 0 ? "" : fmt::format("{:.4f}", frequency_hz);
}

// Centre of mass from the reference node, without the rounding of a coordinate that is zero.
Eigen::Vector2d calc_center(const Superelement& s) {
  const Eigen::Vector2d center = s.inertia.first_moment / s.inertia.mass;
  const double rounding = 1e-14 * s.node_positions.colwise().norm().maxCoeff();
  return (center.cwiseAbs().array() > rounding).select(center, Eigen::Vector2d::Zero());
}

std::string format_points(const Superelement& s) {
  if (s.points.empty()) return "No named points.\n";
  TextTable table({"point", "node", "x m", "y m"});
  for (const NamedPoint& point : s.points) {
    const Eigen::Vector2d position = s.node_positions.col(point.node);
    table.add_row({point.name, fmt::format("{}", s.node_ids[static_cast<std::size_t>(point.node)]),
                   fmt::format("{:.4f}", position.x()), fmt::format("{:.4f}", position.y())});
  }
  return table.str();
}

std::string format_stiffening(const Superelement& s) {
  if (!s.geometric_stiffness) return "stiffening  none: a file of version 1\n";
  const int num_modes = s.geometric_stiffness->num_modes();
  if (num_modes == 0) return "stiffening  none: made from matrices, which do not tell it\n";
  return fmt::format("stiffening  of {} modes\n", num_modes);
}

std::string format_sections(const Superelement& s) {
  if (s.elements.cols() == 0) return "sections    none: made from matrices\n";
  return fmt::format(
      "sections    loads along the beams {}\n"
      "            section modulus known of {} of {} elements\n",
      s.section_loads ? "from the loads on the body and from its modes" : "from its modes only",
      count_sized_elements(s), s.elements.cols());
}

}  // namespace

ModeKinds calc_mode_kinds(const Superelement& s) {
  const ElementWork work = calc_element_work(s);
  ModeKinds kinds;
  kinds.axial_share = work.axial.diagonal().cwiseQuotient((work.axial + work.bending).diagonal());
  // M_ff = L Lᵀ makes the vectors M-orthonormal one after the other; it is I for clamped modes.
  Eigen::MatrixXd momenta(3, s.num_modes());
  momenta << s.inertia.P, s.inertia.c;
  const Eigen::LLT<Eigen::MatrixXd> factor(s.inertia.M_ff);
  const Eigen::MatrixXd orthonormal = factor.matrixL().solve(momenta.transpose());
  kinds.effective_mass = orthonormal.transpose().cwiseAbs2();
  kinds.effective_mass.topRows(2) /= s.inertia.mass;
  kinds.effective_mass.row(2) /= s.inertia.second_moment;
  return kinds;
}

Eigen::Index count_sized_elements(const Superelement& s) {
  return s.section_sizes ? (s.section_sizes->modulus.array() > 0.0).count() : 0;
}

std::string format_summary(const Superelement& s) {
  const InertiaInvariants& inertia = s.inertia;
  const Eigen::Vector2d center = calc_center(s);
  const double central = inertia.second_moment - inertia.first_moment.squaredNorm() / inertia.mass;
  std::string text = fmt::format("Superelement {}: {} nodes, {} elements, {} vectors for {} freedoms\n\n",
                                 s.name, s.num_nodes(), s.elements.cols(), s.num_modes(), s.num_elastic_dofs);
  text += fmt::format("mass                              {:.6g} kg\n", inertia.mass);
  text += fmt::format("centre of mass                    ({:.6g}, {:.6g}) m from the reference node\n",
                      center.x(), center.y());
  text += fmt::format("inertia about the centre of mass  {:.6g} kg·m²\n", central);
  text += fmt::format("inertia about the reference node  {:.6g} kg·m²\n\n", inertia.second_moment);
  text += format_points(s) + "\n";
  text += format_stiffening(s);
  text += format_sections(s);
  text += fmt::format("made by     sprung {}, algorithm revision {}\n", s.provenance.program_version,
                      s.provenance.algorithm_revision);
  text += fmt::format("design      sha256 {}\n", s.provenance.design_hash);
  for (std::size_t i = 0; i < s.provenance.input_names.size(); ++i) {
    text +=
        fmt::format("mesh file   {}, sha256 {}\n", s.provenance.input_names[i], s.provenance.input_hashes[i]);
  }
  return text + fmt::format("contents    sha256 {}\n", s.content_hash);
}

std::string format_modes(const Superelement& s) {
  const ModeKinds kinds = calc_mode_kinds(s);
  TextTable table({"mode", "vector", "frequency Hz", "damping %", "cluster", "kind", "axial energy %",
                   "mass x %", "mass y %", "inertia %"});
  for (Eigen::Index i = 0; i < s.num_modes(); ++i) {
    table.add_row({fmt::format("{}", i + 1), s.kind_of(static_cast<int>(i)),
                   fmt::format("{:.4f}", s.frequency_hz(i)),
                   fmt::format("{:.3g}", 100.0 * s.damping_ratio(i)), fmt::format("{}", s.cluster(i)),
                   format_kind(kinds.axial_share(i)), format_percent(std::abs(kinds.axial_share(i))),
                   format_percent(kinds.effective_mass(0, i)), format_percent(kinds.effective_mass(1, i)),
                   format_percent(kinds.effective_mass(2, i))});
  }
  const Eigen::Vector3d sum = kinds.effective_mass.rowwise().sum();
  table.add_row({"", "", "", "", "", "sum", "", format_percent(sum(0)), format_percent(sum(1)),
                 format_percent(sum(2))});
  std::string text = table.str();
  if (s.has_free_basis()) {
    text +=
        "A free vector is a mode of the free body. The frequency of a residual or constraint vector, and of "
        "the\n"
        "vectors of a fixed interface, is that of the vector alone and no frequency of the body.\n";
  }
  return text;
}

std::string format_checks(std::span<const CheckResult> checks) {
  TextTable table({"check", "value", "tolerance", "result"});
  for (const CheckResult& check : checks) {
    const bool has_tolerance = check.tolerance < kNoTolerance;
    table.add_row({check.name, fmt::format("{:.2e}", check.value),
                   has_tolerance ? fmt::format("{:.2e}", check.tolerance) : "none",
                   !has_tolerance   ? ""
                   : check.passed() ? "passed"
                                    : "FAILED"});
  }
  return table.str();
}

std::string format_comparison(const Comparison& comparison) {
  TextTable table({"old modes", "old Hz", "new modes", "new Hz", "change %", "MAC"});
  for (const ModeMatch& match : comparison.matches) {
    const bool both = match.old_modes.size() > 0 && match.new_modes.size() > 0;
    table.add_row({format_range(match.old_modes), format_frequency(match.old_modes, match.old_hz),
                   format_range(match.new_modes), format_frequency(match.new_modes, match.new_hz),
                   both ? format_change(match.new_hz / match.old_hz - 1.0) : "",
                   std::isnan(match.mac) ? "" : fmt::format("{:.4f}", match.mac)});
  }
  std::string text = table.str();
  if (!comparison.are_alike) {
    text +=
        "Free modes of one body and clamped modes of the other have no MAC; they are paired by their "
        "order.\n";
  } else if (!comparison.comparable) {
    text += fmt::format(
        "The two bodies have too few places in common for a MAC: {:.0f} % of the old body's nodes and "
        "{:.0f} % of the new one's lie on the other, and {:.0f} % must; modes are paired by their order.\n",
        std::floor(100.0 * comparison.share_of_old), std::floor(100.0 * comparison.share_of_new),
        100.0 * kLeastShare);
  }
  if (comparison.num_other_old + comparison.num_other_new > 0) {
    text += fmt::format(
        "Not compared: {} vectors of the old body and {} of the new one, which are no modes of it.\n",
        comparison.num_other_old, comparison.num_other_new);
  }
  return text;
}

}  // namespace sprung::reduce

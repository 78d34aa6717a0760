#include "reduce/export/matrix_market_export.h"

#include "reduce/export/csv_export.h"
#include "reduce/export/text_output.h"
#include "reduce/reduction/inertia_invariants.h"

namespace sprung::reduce {

ExportReport export_matrix_market(const Superelement& s, const std::string& prefix) {
  const std::pair<const char*, std::string> files[] = {
      {"_stiffness.mtx", format_matrix_market(s.stiffness, "modal stiffness, 1/s^2; rows: modes.csv")},
      {"_mass.mtx", format_matrix_market(s.mass, "modal mass; rows: modes.csv")},
      {"_damping.mtx", format_matrix_market(s.damping, "modal damping, 1/s; rows: modes.csv")},
      {"_shapes.mtx", format_matrix_market(s.shapes, "mode shapes; rows: freedoms.csv, columns: modes.csv")},
      {"_body_mass.mtx",
       format_matrix_market(calc_mass_matrix(s.inertia),
                            "mass of the frame's x, y, rotation, then of the modes (modes.csv)")},
      {"_B.mtx",
       format_matrix_market(s.inertia.B, "integral of phi_x' phi_y - phi_y' phi_x; rows: modes.csv")},
      {"_freedoms.csv", format_freedom_table(s)},
      {"_nodes.csv", format_node_table(s)},
      {"_modes.csv", format_mode_table(s)}};
  ExportReport report;
  TextFiles written;
  for (const auto& [ending, text] : files) {
    report.paths.emplace_back(prefix + ending);
    written.add(report.paths.back(), text);
  }
  written.commit();
  report.left_out = {"section loads, deflections under loads, geometric stiffness and the certificate"};
  return report;
}

}  // namespace sprung::reduce

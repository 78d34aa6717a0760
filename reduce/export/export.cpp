#include "reduce/export/export.h"

#include <stdexcept>

#include "reduce/export/csv_export.h"
#include "reduce/export/exudyn_export.h"
#include "reduce/export/matrix_market_export.h"
#include "reduce/export/mbdyn_export.h"
#include "reduce/export/mbsim_export.h"
#include "reduce/export/sid_export.h"

namespace sprung::reduce {

namespace {

struct Target {
  const char* name;
  ExportReport (*write)(const Superelement&, const std::string& prefix);
};

constexpr Target kTargets[] = {
    {"matrix-market", export_matrix_market},
    {"csv", export_csv},
    {"mbdyn", export_mbdyn},
    {"sid", [](const Superelement& s, const std::string& prefix) { return export_sid(s, prefix, false); }},
    {"sid-by-mode",
     [](const Superelement& s, const std::string& prefix) { return export_sid(s, prefix, true); }},
    {"exudyn", export_exudyn},
    {"mbsim", export_mbsim},
};

}  // namespace

std::vector<std::string> list_export_targets() {
  std::vector<std::string> names;
  for (const Target& target : kTargets) names.emplace_back(target.name);
  return names;
}

ExportReport export_superelement(const Superelement& superelement, const std::string& target,
                                 const std::string& prefix) {
  for (const Target& one : kTargets) {
    if (one.name == target) return one.write(superelement, prefix);
  }
  throw std::invalid_argument("export_superelement: '" + target + "' is no target");
}

}  // namespace sprung::reduce

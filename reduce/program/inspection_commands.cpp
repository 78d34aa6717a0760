#include <fmt/format.h>

#include <algorithm>

#include "reduce/export/export.h"
#include "reduce/inspection/certificate_tables.h"
#include "reduce/inspection/comparison.h"
#include "reduce/inspection/superelement_json.h"
#include "reduce/inspection/superelement_tables.h"
#include "reduce/program/commands.h"
#include "reduce/reduction/superelement_checks.h"
#include "reduce/superelement/superelement.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"

namespace sprung::reduce {

namespace {

// What was recorded and cannot be made again without the mesh, then what was made again.
std::vector<CheckResult> collect_checks(const Superelement& superelement) {
  const std::vector<CheckResult> made = check_superelement(superelement);
  std::vector<CheckResult> checks;
  for (const CheckResult& recorded : superelement.checks) {
    const bool again = std::any_of(made.begin(), made.end(),
                                   [&](const CheckResult& check) { return check.name == recorded.name; });
    if (!again) checks.push_back(recorded);
  }
  checks.insert(checks.end(), made.begin(), made.end());
  return checks;
}

}  // namespace

int run_info(const std::filesystem::path& path, bool json) {
  const Superelement superelement = read_superelement(path);
  const std::vector<CheckResult> checks = collect_checks(superelement);
  if (json) {
    support::print(stdout, "{}", format_superelement_json(superelement, checks));
  } else {
    const std::string parts[] = {format_summary(superelement), format_modes(superelement),
                                 format_free_damping(superelement), format_certificate(superelement)};
    for (const std::string& part : parts) {
      if (!part.empty()) support::print(stdout, "{}\n", part);
    }
    support::print(stdout, "{}", format_checks(checks));
  }
  return support::kGood;
}

int run_check(const std::vector<std::filesystem::path>& paths, bool json) {
  bool passed = true;
  for (const std::filesystem::path& path : paths) {
    const std::vector<CheckResult> checks = collect_checks(read_superelement(path));
    const bool all =
        std::all_of(checks.begin(), checks.end(), [](const CheckResult& check) { return check.passed(); });
    passed = passed && all;
    if (json) {
      support::print(stdout, "{}", format_checks_json(path.string(), checks));
    } else {
      support::print(stdout, "{}: {}\n{}", path.string(), all ? "all checks passed" : "a check FAILED",
                     format_checks(checks));
    }
  }
  return passed ? support::kGood : support::kCheckFailed;
}

int run_export(const ExportOptions& options) {
  const ExportReport report =
      export_superelement(read_superelement(options.superelement), options.target, options.prefix);
  for (const std::filesystem::path& path : report.paths) support::print(stdout, "{}\n", path.string());
  for (const std::string& remark : report.left_out) support::print(stdout, "left out: {}\n", remark);
  return support::kGood;
}

int run_diff(const std::filesystem::path& old_path, const std::filesystem::path& new_path, bool json) {
  const Superelement old_body = read_superelement(old_path);
  const Superelement new_body = read_superelement(new_path);
  const Comparison comparison = compare_modes(old_body, new_body);
  support::print(stdout, "{}", json ? format_comparison_json(comparison) : format_comparison(comparison));
  return support::kGood;
}

}  // namespace sprung::reduce

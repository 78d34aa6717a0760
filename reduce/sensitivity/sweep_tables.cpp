#include "reduce/sensitivity/sweep_tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/support/terminal/json.h"
#include "tools/support/terminal/text_table.h"

namespace sprung::reduce {

namespace {

using support::Json;
using support::TextTable;

std::string format_tracked(const SweepOptions& options, const std::vector<SweepPoint>& points,
                           const char* heading, TrackedModes SweepPoint::*member) {
  std::vector<std::string> header{options.key, "mass kg", "inertia kg·m²"};
  for (Eigen::Index i = 0; i < (points.front().*member).hz.size(); ++i)
    header.push_back(fmt::format("mode {} Hz", i + 1));
  TextTable table(header);
  for (const SweepPoint& point : points) {
    std::vector<std::string> row{fmt::format("{:.6g}", point.value), fmt::format("{:.6g}", point.mass),
                                 fmt::format("{:.6g}", point.inertia)};
    const TrackedModes& modes = point.*member;
    for (Eigen::Index i = 0; i < modes.hz.size(); ++i) {
      row.push_back(
          fmt::format("{:.4f}{}", modes.hz(i), modes.correlation(i) < kDoubtfulCorrelation ? "?" : ""));
    }
    table.add_row(row);
  }
  return fmt::format("{}\n{}", heading, table.str());
}

Json make_tracked(const TrackedModes& modes) {
  return {{"frequency_hz", std::vector<double>(modes.hz.begin(), modes.hz.end())},
          {"correlation", std::vector<double>(modes.correlation.begin(), modes.correlation.end())}};
}

}  // namespace

std::string format_sweep(const SweepOptions& options, const std::vector<SweepPoint>& points) {
  const bool is_passed = std::any_of(points.begin(), points.end(), [](const SweepPoint& point) {
    return point.free.is_passed || point.clamped.is_passed;
  });
  const std::string remark =
      options.is_preview ? "Preview: all but the first line by the modes of the first line\n\n" : "";
  return remark +
         format_tracked(options, points, "Modes of the free body, each followed by its shape",
                        &SweepPoint::free) +
         "\n" +
         format_tracked(options, points, "Modes of the body clamped at its reference node",
                        &SweepPoint::clamped) +
         (is_passed
              ? "\nA mode that came down from above those of the first line is in no column; more --modes "
                "show it.\n"
              : "");
}

std::string format_sweep_json(const SweepOptions& options, const std::vector<SweepPoint>& points) {
  Json items = Json::array();
  for (const SweepPoint& point : points) {
    items.push_back({{"value", point.value},
                     {"mass_kg", point.mass},
                     {"inertia_kg_m2", point.inertia},
                     {"free", make_tracked(point.free)},
                     {"clamped", make_tracked(point.clamped)}});
  }
  return support::format_json({{"key", options.key}, {"preview", options.is_preview}, {"points", items}});
}

}  // namespace sprung::reduce

#include "dynamics/output/section_report.h"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

using support::Json;

namespace {

std::string format_value(double value) {
  return fmt::format("{:.6g}", value);
}

}  // namespace

std::string format_sections(const SectionStatistics& statistics, bool at_rest) {
  std::vector<std::string> heads{"body", "from loads N·m", "at x m", "y m"};
  if (!at_rest) heads.emplace_back("time s");
  heads.insert(heads.end(), {"from modes N·m", "largest difference N·m", "modes miss %"});
  support::TextTable table(heads);
  for (std::size_t b = 0; b < statistics.peaks().size(); ++b) {
    const BodySections& body = statistics.sections().bodies()[b];
    const SectionPeaks& peaks = statistics.peaks()[b];
    const bool has_both = body.has_loads() && body.has_modes();
    const SectionPeak& peak = (body.has_loads() ? peaks.from_loads : peaks.from_modes)[SectionPeaks::kMoment];
    std::vector<std::string> row{body.name(), body.has_loads() ? format_value(peak.value) : "",
                                 format_value(body.positions()(peak.station, 0)),
                                 format_value(body.positions()(peak.station, 1))};
    if (!at_rest) row.push_back(fmt::format("{:.3f}", peak.time));
    row.push_back(body.has_modes() ? format_value(peaks.from_modes[SectionPeaks::kMoment].value) : "");
    row.push_back(has_both ? format_value(peaks.difference[SectionPeaks::kMoment].value) : "");
    row.push_back(body.has_missing() ? fmt::format("{:.3g}", 100.0 * peaks.missing_moment_share()) : "");
    table.add_row(row);
  }
  if (statistics.peaks().empty()) return "";
  return "\nLargest bending moments along the beams\n" + table.str();
}

Json make_sections_json(const SectionStatistics& statistics) {
  Json bodies = Json::object();
  for (std::size_t b = 0; b < statistics.peaks().size(); ++b) {
    const BodySections& body = statistics.sections().bodies()[b];
    const SectionPeaks& peaks = statistics.peaks()[b];
    Json quantities = Json::object();
    for (std::size_t i = 0; i < kQuantityNames.size(); ++i) {
      const auto describe = [&](const SectionPeak& peak) -> Json {
        return {{"value", peak.value},
                {"position", {body.positions()(peak.station, 0), body.positions()(peak.station, 1)}},
                {"time", peak.time}};
      };
      Json& quantity = quantities[kQuantityNames[i]];
      if (body.has_loads()) quantity["from_loads"] = describe(peaks.from_loads[i]);
      if (body.has_modes()) quantity["from_modes"] = describe(peaks.from_modes[i]);
      if (body.has_loads() && body.has_modes()) quantity["difference"] = describe(peaks.difference[i]);
    }
    if (body.has_missing()) {
      quantities["missing_moment_share"] = peaks.missing_moment_share();
      quantities["missing_deflection_share"] = peaks.missing_deflection_share();
    }
    bodies[body.name()] = quantities;
  }
  return bodies;
}

}  // namespace sprung::dynamics

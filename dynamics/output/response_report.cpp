#include "dynamics/output/response_report.h"

#include <fmt/format.h>

#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

using support::Json;

namespace {

std::vector<double> row_of(const Eigen::MatrixXd& matrix, Eigen::Index row) {
  const Eigen::VectorXd values = matrix.row(row);
  return {values.begin(), values.end()};
}

}  // namespace

bool is_main_output(const OutputSubject& subject) {
  if (subject.kind == OutputSubject::Kind::kPoint) return subject.component == 1;
  if (subject.kind != OutputSubject::Kind::kChannel) return false;
  return subject.role == ChannelRole::kForce || subject.role == ChannelRole::kTorque ||
         subject.role == ChannelRole::kDeflection;
}

std::string format_response(const ResponseResult& result) {
  const std::vector<double>& f = result.frequency_hz;
  std::string text = fmt::format(
      "{}: response to the road at {:g} m/s, linearised about static equilibrium; {} frequencies from {:g} "
      "to {:g} Hz\n",
      result.vehicle.name, result.run.speed, f.size(), f.front(), f.back());
  for (const RunWarning& warning : result.warnings) text += fmt::format("warning: {}\n", warning.text);
  for (const std::string& remark : result.remarks) text += remark + "\n";
  if (result.has_road()) text += fmt::format("Road: r.m.s. height {:.4g} m in this range\n", result.road_rms);

  std::vector<std::string> header{"quantity", "unit", fmt::format("per m of road: at {:g} Hz", f.front()),
                                  "largest", "at Hz"};
  if (result.has_road()) header.emplace_back("r.m.s.");
  support::TextTable table(header);
  for (std::size_t i = 0; i < result.names.size(); ++i) {
    if (!is_main_output(result.subjects[i])) continue;
    const auto row = static_cast<Eigen::Index>(i);
    Eigen::Index peak = 0;
    const double largest = result.response.row(row).cwiseAbs().maxCoeff(&peak);
    std::vector<std::string> cells{
        result.names[i], result.units[i], fmt::format("{:.4g}", std::abs(result.response(row, 0))),
        fmt::format("{:.4g}", largest), fmt::format("{:.3f}", f[static_cast<std::size_t>(peak)])};
    if (result.has_road()) cells.push_back(fmt::format("{:.5g}", result.rms[row]));
    table.add_row(cells);
  }
  return fmt::format("{}\n{}", text, table.str());
}

Json make_response_json(const ResponseResult& result) {
  Json outputs = Json::object();
  for (std::size_t i = 0; i < result.names.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Json output{{"unit", result.units[i]},
                {"real", row_of(result.response.real(), row)},
                {"imaginary", row_of(result.response.imag(), row)}};
    if (result.has_road()) {
      output["spectrum"] = row_of(result.spectrum, row);
      output["rms"] = result.rms[row];
    }
    outputs[result.names[i]] = std::move(output);
  }
  Json report{{"remarks", result.remarks}, {"frequency", result.frequency_hz}};
  if (result.has_road()) {
    report["road_rms"] = result.road_rms;
    report["road_spectrum"] = std::vector<double>(result.road_spectrum.begin(), result.road_spectrum.end());
  }
  report["outputs"] = std::move(outputs);
  return report;
}

}  // namespace sprung::dynamics

#include "dynamics/output/choice_report.h"

#include <fmt/format.h>

#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

using support::Json;

namespace {

std::string percent(double share) {
  return fmt::format("{:.{}g}", 100.0 * share, share < 0.995 ? 2 : 3);
}

// The shares of a mode, in the order of the table's columns.
struct Column {
  const char* name;
  double (*value)(const ModeWorth&);
};
constexpr Column kColumns[] = {
    {"displacement_rms", [](const ModeWorth& worth) { return worth.displacement.rms; }},
    {"displacement_peak", [](const ModeWorth& worth) { return worth.displacement.peak; }},
    {"acceleration_rms", [](const ModeWorth& worth) { return worth.acceleration.rms; }},
    {"acceleration_peak", [](const ModeWorth& worth) { return worth.acceleration.peak; }},
    {"force_rms", [](const ModeWorth& worth) { return worth.force.rms; }},
    {"force_peak", [](const ModeWorth& worth) { return worth.force.peak; }},
    {"static", [](const ModeWorth& worth) { return worth.weight; }},
};

}  // namespace

std::string summarise_choice(const BasisChoice& choice) {
  const std::size_t left_out = choice.verdicts.size() - choice.num_kept();
  std::string text =
      fmt::format("Modes chosen from the forcing: {} of {} kept; the share left out must be below {:g} %",
                  choice.num_kept(), choice.verdicts.size(), 100.0 * choice.tolerance);
  if (left_out > 0) {
    text += fmt::format(", predicted {} % of the {}", percent(choice.neglected), choice.neglected_of);
  }
  text += "\n";
  for (const std::string& remark : choice.remarks) text += fmt::format("remark: {}\n", remark);
  return text;
}

std::string format_choice(const BasisChoice& choice) {
  support::TextTable table({"body", "mode", "Hz", "displacement r.m.s. %", "peak %", "acceleration r.m.s. %",
                            "peak %", "forces, moments r.m.s. %", "peak %", "static %", "why"});
  const bool is_measured = !choice.frequency_hz.empty();
  for (const ModeVerdict& verdict : choice.verdicts) {
    std::vector<std::string> cells{verdict.mode.body, fmt::format("{}", verdict.mode.number),
                                   fmt::format("{:.2f}", verdict.mode.frequency_hz)};
    for (const Column& column : kColumns) {
      cells.push_back(is_measured ? percent(column.value(verdict.worth)) : std::string("-"));
    }
    cells.push_back(verdict.reason);
    table.add_row(cells);
  }
  return summarise_choice(choice) + "\n" + table.str();
}

support::Json make_choice_json(const BasisChoice& choice) {
  Json modes = Json::array();
  for (const ModeVerdict& verdict : choice.verdicts) {
    Json mode{{"body", verdict.mode.body},
              {"number", verdict.mode.number},
              {"frequency", verdict.mode.frequency_hz},
              {"kept", verdict.is_kept},
              {"reason", verdict.reason}};
    if (!choice.frequency_hz.empty()) {
      for (const Column& column : kColumns) mode["share"][column.name] = column.value(verdict.worth);
    }
    modes.push_back(std::move(mode));
  }
  return {{"tolerance", choice.tolerance},
          {"neglected", choice.neglected},
          {"neglected_of", choice.neglected_of},
          {"remarks", choice.remarks},
          {"modes", std::move(modes)}};
}

void write_choice(support::Hdf5Writer& file, const std::string& group, const BasisChoice& choice) {
  file.make_group(group);
  file.attribute(group, "tolerance", choice.tolerance);
  file.attribute(group, "neglected", choice.neglected);
  file.attribute(group, "neglected_of", choice.neglected_of);
  std::vector<std::string> bodies, reasons;
  std::vector<std::int64_t> numbers, kept;
  std::vector<double> frequencies;
  for (const ModeVerdict& verdict : choice.verdicts) {
    bodies.push_back(verdict.mode.body);
    numbers.push_back(verdict.mode.number);
    frequencies.push_back(verdict.mode.frequency_hz);
    kept.push_back(verdict.is_kept ? 1 : 0);
    reasons.push_back(verdict.reason);
  }
  file.write(group + "/body", bodies);
  file.write(group + "/mode_number", numbers);
  file.write(group + "/mode_frequency", frequencies, "Hz");
  file.write(group + "/kept", kept);
  file.write(group + "/reason", reasons);
  file.write(group + "/remarks", choice.remarks);
  if (choice.frequency_hz.empty()) return;
  for (const Column& column : kColumns) {
    std::vector<double> shares;
    for (const ModeVerdict& verdict : choice.verdicts) shares.push_back(column.value(verdict.worth));
    file.write(group + "/share/" + column.name, shares, "1");
  }
  file.write(group + "/frequency", choice.frequency_hz, "Hz");
  file.write(group + "/road", choice.road, "m/Hz");
  for (std::size_t i = 0; i < choice.transfer_names.size(); ++i) {
    file.write(group + "/transfer/" + choice.transfer_names[i],
               Eigen::VectorXd(choice.transfer.row(static_cast<Eigen::Index>(i)).transpose()), "m/s^2/m");
  }
}

}  // namespace sprung::dynamics

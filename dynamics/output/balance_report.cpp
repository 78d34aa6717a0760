#include "dynamics/output/balance_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>

#include "dynamics/output/moving_bodies.h"
#include "dynamics/output/resting_forces.h"
#include "dynamics/output/section_report.h"
#include "dynamics/section_loads/body_remarks.h"
#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

using support::Json;

namespace {

// Without those of the files, which were told when they were read.
std::string format_warnings(const std::vector<RunWarning>& warnings) {
  std::string text;
  for (const RunWarning& warning : warnings) {
    if (!goes_to_stderr(warning)) text += fmt::format("\nwarning: {}\n", warning.text);
  }
  return text;
}

}  // namespace

std::vector<RunWarning> list_balance_warnings(const Vehicle& vehicle, const RestingSections& sections,
                                              const std::vector<std::string>& file_remarks) {
  std::vector<RunWarning> warnings;
  const auto add = [&warnings](const std::vector<BodyRemark>& remarks) {
    for (const BodyRemark& remark : remarks) warnings.push_back({"sections", {remark.body}, remark.text});
  };
  add(list_missing_parts(sections.loads, vehicle.judged));
  add(list_large_bending(sections.bending));
  for (RunWarning& remark : list_file_warnings(file_remarks)) warnings.push_back(std::move(remark));
  return warnings;
}

std::string format_equilibrium(const BalanceReport& report) {
  const Equilibrium& equilibrium = report.equilibrium;
  std::string text =
      fmt::format("{}: {} after {} iterations, last step {:.1e} of the natural size{}{}\n",
                  report.vehicle.name, report.is_steady ? "steady motion" : "static equilibrium",
                  equilibrium.iterations, equilibrium.last_step,
                  equilibrium.is_usual()
                      ? ""
                      : fmt::format(", limited by rounding (otherwise {:.0e})", Equilibrium::kTolerance),
                  equilibrium.stable ? "" : "; UNSTABLE: a direction of negative stiffness");
  text += report.assembly.describe_shift();
  if (report.assembly.largest_movement > 1e-9) {
    text += fmt::format("Joints closed first: {} moved {:.3g} m\n", report.assembly.moved_marker,
                        report.assembly.largest_movement);
  }
  for (const std::string& neutral : equilibrium.describe_neutral()) {
    text += fmt::format("Neutral, held at its start value: {}\n", neutral);
  }
  support::TextTable bodies({"body", "x m", "y m", "angle rad", "from file: x mm", "y mm", "angle mrad"});
  for (const Body& body : report.model.bodies) {
    const Eigen::Vector3d position = equilibrium.q.segment<3>(body.first_coordinate);
    const Eigen::Vector3d moved = 1e3 * (position - report.file_positions.segment<3>(body.first_coordinate));
    std::vector<std::string> row{body.name};
    for (const double value : position) row.push_back(support::format_fixed(value, 6));
    for (const double value : moved) row.push_back(support::format_fixed(value, 3));
    bodies.add_row(row);
  }
  text += fmt::format("\n{}", bodies.str());

  if (!report.model.forces.empty()) {
    support::TextTable forces({"force element", "quantity", "value", "unit"});
    const RestingForces resting(report.model, equilibrium.q);
    for (std::size_t f = 0; f < report.model.forces.size(); ++f) {
      const std::vector<double> values = resting.calc_channels(f);
      for (std::size_t c = 0; c < values.size(); ++c) {
        const Channel& channel = report.model.forces[f]->channels()[c];
        if (channel.role == ChannelRole::kRate || channel.role == ChannelRole::kRoadHeight) continue;
        forces.add_row({c == 0 ? report.model.forces[f]->name : "", std::string(channel.name),
                        fmt::format("{:.6g}", values[c] + 0.0), std::string(channel.unit)});
      }
    }
    text += fmt::format("\n{}", forces.str());
  }
  if (report.sections == nullptr) return text;
  text += format_sections(*report.sections, true);
  return text + format_warnings(report.warnings);
}

Json make_equilibrium_json(const BalanceReport& report) {
  Json bodies = Json::object(), forces = Json::object();
  for (const Body& body : report.model.bodies) {
    const Eigen::Vector3d position = report.equilibrium.q.segment<3>(body.first_coordinate);
    bodies[body.name] = {{"x", position[0]}, {"y", position[1]}, {"angle", position[2]}};
  }
  const RestingForces resting(report.model, report.equilibrium.q);
  for (std::size_t f = 0; f < report.model.forces.size(); ++f) {
    const std::vector<double> values = resting.calc_channels(f);
    Json channels = Json::object();
    for (std::size_t c = 0; c < values.size(); ++c)
      channels[report.model.forces[f]->channels()[c].name] = values[c];
    forces[report.model.forces[f]->name] = std::move(channels);
  }
  return {{"bodies", bodies},
          {"forces", forces},
          {"sections", report.sections ? make_sections_json(*report.sections) : Json::object()},
          {"neutral", report.equilibrium.describe_neutral()},
          {"stable", report.equilibrium.stable},
          {"iterations", report.equilibrium.iterations},
          {"last_step", report.equilibrium.last_step}};
}

std::string format_modes(const Model& model, const Vehicle& vehicle, const std::vector<VehicleMode>& modes,
                         const std::vector<Kink>& kinks, const std::vector<RunWarning>& warnings,
                         bool is_steady) {
  std::vector<std::string> two_slopes;
  for (const Kink& kink : kinks)
    if (!kink.in_position) two_slopes.push_back(kink.element);
  std::string text = fmt::format(
      "{}: modes about {}, {} freedoms\n{}{}\n", vehicle.name,
      is_steady ? "steady motion" : "static equilibrium", model.num_mechanical_freedoms(),
      two_slopes.empty()
          ? ""
          : fmt::format("With the mean of the two slopes at rest: {}\n", fmt::join(two_slopes, ", ")),
      model.num_states() > 0
          ? "Undamped frequencies are without friction of leaf springs and parts that relax or "
            "flow; damped frequencies contain them.\n"
          : "");
  support::TextTable table({"mode", "undamped Hz", "damped Hz", "damping ratio", "kinetic energy"});
  int number = 0;
  for (const VehicleMode& mode : modes) {
    ++number;
    std::string movers = describe_moving_bodies(model, vehicle, mode);
    if (mode.decay_rate) {
      movers = fmt::format("does not oscillate, {} at {:.3g} 1/s: {}",
                           *mode.decay_rate < 0.0 ? "grows" : "decays", std::abs(*mode.decay_rate), movers);
    }
    if (mode.is_rigid_body && mode.damped_frequency_hz == 0.0) {
      table.add_row({fmt::format("{}", number), "0", "0", "", "rigid-body mode: " + movers});
    } else {
      table.add_row({fmt::format("{}", number), fmt::format("{:.4f}", mode.undamped_frequency_hz),
                     support::format_fixed(mode.damped_frequency_hz, 4),
                     support::format_fixed(mode.damping_ratio, 4), movers});
    }
  }
  text += table.str();
  return text + format_warnings(warnings);
}

bool FrequencyBracket::may_be_in_band(const std::vector<VehicleMode>& modes, std::size_t mode) const {
  return !modes[mode].is_rigid_body && lower_hz[static_cast<Eigen::Index>(mode)] < highest_hz;
}

std::string format_bracket(const Vehicle& vehicle, const Model& model, const std::vector<VehicleMode>& modes,
                           const FrequencyBracket& bracket) {
  support::TextTable table({"mode", "at least Hz", "at most Hz", "width"});
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (!bracket.may_be_in_band(modes, k)) continue;
    const double lower = bracket.lower_hz[static_cast<Eigen::Index>(k)],
                 upper = bracket.upper_hz[static_cast<Eigen::Index>(k)];
    table.add_row({fmt::format("{}", k + 1), fmt::format("{:.6f}", lower), fmt::format("{:.6f}", upper),
                   lower > 0.0 ? fmt::format("{:.1e}", upper / lower - 1.0) : ""});
  }
  const std::string band =
      std::isfinite(bracket.highest_hz) ? fmt::format(" up to {:.6g} Hz", bracket.highest_hz) : "";
  std::vector<std::string> rigid;
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b)
    if (vehicle.superelement_of(vehicle.bodies[b]) && model.bodies[b].num_modes() == 0)
      rigid.push_back(vehicle.bodies[b].name);
  return fmt::format(
      "\nBrackets of the undamped frequencies{}, of the vehicle with all motions of the bodies that have "
      "modes here{}, linearised about its equilibrium, with the body frames at their reference nodes\n{}",
      band, rigid.empty() ? "" : fmt::format(" ({} rigid)", fmt::join(rigid, ", ")), table.str());
}

Json make_modes_json(const Model& model, const Vehicle& vehicle, const std::vector<VehicleMode>& modes,
                     const SectionStatistics& sections, const FrequencyBracket* bracket) {
  Json list = Json::array();
  for (const VehicleMode& mode : modes) {
    list.push_back({{"undamped_frequency", mode.undamped_frequency_hz},
                    {"damped_frequency", mode.damped_frequency_hz},
                    {"damping_ratio", mode.damping_ratio},
                    {"rigid_body", mode.is_rigid_body},
                    {"participants", describe_moving_bodies(model, vehicle, mode)}});
    if (mode.decay_rate) list.back()["decay_rate"] = *mode.decay_rate;
    if (bracket != nullptr && bracket->may_be_in_band(modes, list.size() - 1)) {
      const auto k = static_cast<Eigen::Index>(list.size()) - 1;
      list.back()["bracket"] = {bracket->lower_hz[k], bracket->upper_hz[k]};
    }
  }
  return {{"modes", list}, {"sections", make_sections_json(sections)}};
}

}  // namespace sprung::dynamics

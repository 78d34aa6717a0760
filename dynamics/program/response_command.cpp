#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dynamics/output/response_report.h"
#include "dynamics/output/response_writer.h"
#include "dynamics/preparation/start_state.h"
#include "dynamics/program/commands.h"
#include "dynamics/program/model_report.h"
#include "dynamics/program/response_warnings.h"
#include "dynamics/response/linear_outputs.h"
#include "dynamics/response/random_linearisation.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/hdf5/foreign_file.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"

namespace sprung::dynamics {

namespace {

void check_request(const Run& run) {
  if (run.start == Run::Start::kSteady) {
    throw support::InputError(
        run.start_location, "'start' must not be \"steady\" for a response, which needs static equilibrium");
  }
  if (!(run.speed > 0.0)) {
    throw support::InputError(
        run.speed_location,
        fmt::format("a response to the road needs a 'speed' above 0 m/s, got {}", run.speed));
  }
}

void check_stability(const PreparedRun& prepared, const LinearVehicle& vehicle) {
  const Eigen::VectorXcd eigenvalues = vehicle.solver().eigenvalues();
  const double growth = eigenvalues.real().maxCoeff();
  if (!prepared.equilibrium->stable || has_growth(eigenvalues)) {
    throw support::NumericalError(fmt::format(
        "response: the equilibrium is unstable (growth {:.3g} 1/s), so there is no steady linear response",
        growth));
  }
}

void check_inputs(const PreparedRun& prepared, const LinearVehicle& vehicle) {
  const std::vector<RoadInput>& inputs = vehicle.inputs();
  if (inputs.empty()) {
    throw support::InputError(
        prepared.run.vehicle_location,
        "the vehicle has no force element on the road, of type \"tyre\", so the road cannot excite it");
  }
  if (std::none_of(inputs.begin(), inputs.end(), [](const RoadInput& input) { return input.is_pressed; })) {
    throw support::NumericalError("response: no wheel is on the ground in static equilibrium");
  }
}

// A line for the heading, "" for no elements.
std::string list_elements(const char* what, const std::vector<std::string>& elements) {
  return elements.empty() ? "" : fmt::format("{}: {}", what, fmt::join(elements, ", "));
}

// Linearises friction, orifices and dampers for the motion on the road. @return lines for the heading
std::vector<std::string> linearise_for_road(const Run& run, LinearVehicle& vehicle) {
  std::vector<std::string> with_states, dampers;
  const FrequencyRange range{.from = run.response.from, .to = run.response.to};
  for (const RandomLinearisation& one :
       linearise_for_random_motion(vehicle, *run.response.road, run.speed, range)) {
    if (one.has_states) with_states.push_back(fmt::format("{} ({:.3g} m)", one.element, one.rms_deflection));
    if (one.rms_rates.empty()) continue;
    std::vector<std::string> rates;
    for (std::size_t i = 0; i < one.rms_rates.size(); ++i)
      rates.push_back(fmt::format("{:.3g} {}", one.rms_rates[i], one.rate_units[i]));
    dampers.push_back(fmt::format("{} ({})", one.element, fmt::join(rates, ", ")));
  }
  return {
      list_elements("Dampers linearised for the r.m.s. rate on this road", dampers),
      list_elements("Friction and orifices linearised for the r.m.s. deflection on this road", with_states)};
}

// What is linear near rest alone, where there is no road that gives an amplitude. @return lines for the
// heading
std::vector<std::string> describe_laws_at_rest(const LinearVehicle& vehicle) {
  std::vector<std::string> with_states, dampers;
  for (std::size_t f = 0; f < vehicle.model().forces.size(); ++f) {
    const RandomLaws laws = find_random_laws(vehicle, f);
    const std::string& name = vehicle.model().forces[f]->name;
    if (laws.states) with_states.push_back(name);
    const bool has_two_slopes =
        std::any_of(vehicle.kinks().begin(), vehicle.kinks().end(),
                    [&](const Kink& kink) { return !kink.in_position && kink.element == name; });
    if (!laws.rate_slopes.empty() && !has_two_slopes) dampers.push_back(name);
  }
  return {
      list_elements("Dampers have their slope at rest, since without response.road they have no amplitude",
                    dampers),
      list_elements("Friction holds and orifices let pass as near rest, since without response.road they "
                    "have no amplitude",
                    with_states)};
}

// Elements whose law changes with the sign of a rate and has not been linearised for the road.
std::string describe_mean_slopes(const LinearVehicle& vehicle, bool has_road) {
  std::vector<std::string> names;
  const auto& forces = vehicle.model().forces;
  for (const Kink& kink : vehicle.kinks()) {
    if (kink.in_position) continue;
    const auto found = std::find_if(forces.begin(), forces.end(),
                                    [&](const auto& force) { return force->name == kink.element; });
    const RandomLaws laws = find_random_laws(vehicle, static_cast<std::size_t>(found - forces.begin()));
    if (has_road && !laws.is_empty()) continue;
    names.push_back(kink.element);
  }
  return list_elements("Linearised with the mean of the two slopes at rest", names);
}

// Gives the vehicle the laws that belong to the road. @return lines for the heading
std::vector<std::string> linearise_laws(const Run& run, LinearVehicle& vehicle) {
  const bool has_road = run.response.road.has_value();
  std::vector<std::string> remarks{describe_mean_slopes(vehicle, has_road)};
  for (std::string& one : has_road ? linearise_for_road(run, vehicle) : describe_laws_at_rest(vehicle))
    remarks.push_back(std::move(one));
  std::erase(remarks, "");
  return remarks;
}

// Lines for the heading about modes that were chosen.
std::vector<std::string> describe_choice(const PreparedRun& prepared) {
  if (!prepared.choice) return {};
  const BasisChoice& choice = *prepared.choice;
  std::vector<std::string> kept;
  for (const ModeVerdict& verdict : choice.verdicts)
    if (verdict.is_kept) kept.push_back(fmt::format("{} {}", verdict.mode.body, verdict.mode.number));
  std::vector<std::string> lines{
      fmt::format("Modes chosen from the road of {}, {} of {}: {}",
                  prepared.run.response.road ? "[response.road]" : "[road]", kept.size(),
                  choice.verdicts.size(), kept.empty() ? "none" : fmt::format("{}", fmt::join(kept, ", ")))};
  lines.insert(lines.end(), choice.remarks.begin(), choice.remarks.end());
  return lines;
}

LinearOutputs make_outputs(const PreparedRun& prepared, const LinearVehicle& vehicle) {
  LinearOutputs outputs = make_force_outputs(vehicle);
  for (const std::string& point : resolve_response_points(prepared.run, prepared.vehicle)) {
    outputs.append(make_point_outputs(vehicle, vehicle.model().find_marker(point)));
  }
  outputs.append(make_modal_outputs(vehicle));
  outputs.append(make_reaction_outputs(vehicle));
  return outputs;
}

}  // namespace

int response_command(const RunRequest& request, const RunOutput& output) {
  if (support::is_foreign_file(output.results, kResponseFormat)) {
    throw support::InputError(
        {.path = output.results.string()},
        "exists and is no response file, so it is not overwritten; move it or name another with -o");
  }
  const PreparedRun prepared = prepare_run(request, Preparation::kResponse);
  check_request(prepared.run);
  if (prepared.balance_model.num_freedoms() == 0) {
    throw support::InputError(prepared.run.vehicle_location, "the vehicle has no freedom to respond with");
  }
  LinearVehicle vehicle(prepared.balance_model, prepared.equilibrium->q);
  check_inputs(prepared, vehicle);
  check_stability(prepared, vehicle);
  const std::vector<std::string> remarks = linearise_laws(prepared.run, vehicle);
  ResponseResult result =
      calc_response_result(prepared.run, prepared.vehicle, vehicle, make_outputs(prepared, vehicle));
  result.overrides = request.overrides;
  result.warnings = list_response_warnings(prepared, vehicle, result);
  result.remarks = describe_choice(prepared);
  result.remarks.insert(result.remarks.end(), remarks.begin(), remarks.end());

  if (!output.results.empty()) write_response(output.results, result);
  if (output.json) {
    std::vector<RunWarning> warnings = result.warnings;
    for (RunWarning& remark : list_file_warnings(prepared.remarks)) warnings.push_back(std::move(remark));
    support::print(request.streams.out, "{}",
                   format_report_json(request, "response", prepared, warnings, make_response_json(result)));
  } else {
    support::print(request.streams.out, "{}", format_response(result));
  }
  if (!output.results.empty() && !output.json)
    support::print(request.streams.out, "Response: {}\n", output.results.string());
  return support::kGood;
}

}  // namespace sprung::dynamics

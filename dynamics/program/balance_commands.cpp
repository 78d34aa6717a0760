#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "dynamics/bracket/axial_change.h"
#include "dynamics/bracket/soft_twin.h"
#include "dynamics/linear/frequency_bounds.h"
#include "dynamics/linear/linearisation.h"
#include "dynamics/linear/state_derivatives.h"
#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/output/balance_report.h"
#include "dynamics/program/commands.h"
#include "dynamics/program/model_report.h"
#include "dynamics/section_loads/resting_sections.h"
#include "dynamics/statistics/run_warnings.h"
#include "dynamics/system/held_modes.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"

namespace sprung::dynamics {

namespace {

constexpr double kUncertain = 1e-7;  // natural sizes: an equilibrium that is less exact is warned of

void warn_of_rounding(const Equilibrium& equilibrium, std::vector<RunWarning>& warnings) {
  if (equilibrium.last_step <= kUncertain) return;
  warnings.push_back(
      {"modes",
       {"equilibrium"},
       fmt::format(
           "the equilibrium is exact to {:.1e} of the natural size only, limited by rounding beside the "
           "largest stiffness: frequencies that weight or preload cause may be wrong; leave out the "
           "stiffest modes, or start nearer to the equilibrium",
           equilibrium.last_step)});
}

// Modes whose frequency rounding leaves open: by more than a ten-thousandth, or, of one that is taken for
// rigid, by more than a hundredth of the lowest other one or, if that is lower, of the frequency of a
// pendulum of the vehicle's size.
void warn_of_rounded_modes(const Model& model, const std::vector<VehicleMode>& modes,
                           std::vector<RunWarning>& warnings) {
  constexpr double kExact = 1e-4, kRigid = 1e-2;
  double lowest =
      std::max(1.0, std::sqrt(model.gravity.norm() / model.length_scale)) / (2.0 * std::numbers::pi);
  for (const VehicleMode& mode : modes)
    if (!mode.is_rigid_body) lowest = std::min(lowest, mode.undamped_frequency_hz);
  std::vector<std::string> open;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const VehicleMode& mode = modes[k];
    const double exact = mode.is_rigid_body ? kRigid * lowest : (1.0 + kExact) * mode.undamped_frequency_hz;
    if (mode.largest_frequency_hz > exact)
      open.push_back(fmt::format("{} (up to {:.5g} Hz)", k + 1, mode.largest_frequency_hz));
  }
  if (open.empty()) return;
  constexpr std::size_t kNamed = 5;
  if (open.size() > kNamed) {
    const std::size_t others = open.size() - kNamed;
    open.resize(kNamed);
    open.push_back(fmt::format("and {} more", others));
  }
  warnings.push_back(
      {"modes",
       {"frequencies"},
       fmt::format(
           "rounding beside the largest stiffness leaves the frequencies of these modes open: {}; take "
           "stiffer reference nodes, at which the body frames sit, or leave out the stiffest modes and "
           "elements",
           fmt::join(open, ", "))});
}

// Kinks of force laws at the equilibrium.
std::vector<Kink> find_kinks_at_balance(const PreparedRun& prepared) {
  const Eigen::VectorXd& q = prepared.equilibrium->q;
  PartitionedEquations equations(prepared.balance_model);
  equations.choose_partition_at(0.0, q);
  return find_kinks(equations, 0.0, q(equations.partition().independent), prepared.equilibrium->motion);
}

// What linear modes cannot show of the forces at rest.
void warn_of_forces_at_rest(const PreparedRun& prepared, const std::vector<Kink>& kinks,
                            std::vector<RunWarning>& warnings) {
  if (!prepared.equilibrium->motion.is_rest()) return;
  const auto warn = [&](std::string text) {
    warnings.push_back({"modes", {"frequencies"}, std::move(text)});
  };
  const Model& model = prepared.balance_model;
  const Eigen::VectorXd& q = prepared.equilibrium->q;
  PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  Eigen::MatrixXd spread;
  const LinearisedSystem system = linearise(equations, 0.0, q, {}, &spread);
  const Eigen::Index n = system.mass.rows() - model.num_states();
  if (!is_symmetric(system.stiffness.topLeftCorner(n, n),
                    (system.stiffness_rounding + spread).topLeftCorner(n, n))) {
    warn(
        "the stiffness at rest is not symmetric, as with forces that follow a body: the undamped frequencies "
        "are those of its symmetric part; the damped ones are right");
  }
  for (const Kink& kink : kinks)
    if (kink.in_position) warn(kink.describe());
}

// Bodies whose bending in a mode is damped far less than their design asks for: each vector is damped at its
// own frequency, which may be much higher than that of the mode (reduce/basis, eq. 8).
void warn_of_lost_damping(const Vehicle& vehicle, const Model& model, const std::vector<VehicleMode>& modes,
                          std::vector<RunWarning>& warnings) {
  constexpr double kMostly = 0.5, kLost = 0.5;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.num_modes() == 0) continue;
    const std::optional<reduce::Certificate>& certificate =
        vehicle.superelement_of(vehicle.bodies[b])->certificate;
    for (std::size_t k = 0; k < modes.size(); ++k) {
      if (modes[k].is_rigid_body) continue;
      if (certificate && modes[k].undamped_frequency_hz > certificate->highest_hz) break;
      const double omega = 2.0 * std::numbers::pi * modes[k].undamped_frequency_hz;
      const Eigen::VectorXd eta = modes[k].shape.segment(body.first_coordinate + 3, body.num_modes());
      const Eigen::ArrayXd energies = body.stiffness.diagonal().array() * eta.array().square();
      const Eigen::ArrayXd ratios = 0.5 * body.damping.diagonal().array() /
                                    (body.stiffness.diagonal().array() * body.modal_mass.array()).sqrt();
      const double asked = (ratios * energies).sum() / (omega * omega),
                   found = 0.5 * eta.dot(body.damping * eta) / omega;
      if (energies.sum() < kMostly * omega * omega || found >= kLost * asked) continue;
      warnings.push_back(
          {"modes",
           {body.name},
           fmt::format(
               "{} damps its bending in mode {}, {:.5g} Hz, by a ratio of {:.2g} where {:.2g} is asked "
               "for: its vectors have higher frequencies, and each is damped at its own; take clamped "
               "modes with the reference where the body is held, or raise its damping",
               body.name, k + 1, modes[k].undamped_frequency_hz, found, asked)});
      break;
    }
  }
}

// Prints the warnings about the model at once, as a run does. @return these, and those about the balance
std::vector<RunWarning> report_warnings(const PreparedRun& prepared, const RestingSections& resting,
                                        std::FILE* err) {
  std::vector<RunWarning> warnings =
      list_model_warnings(prepared.balance_model, prepared.assembly, prepared.start, nullptr);
  for (const RunWarning& one : warnings) support::print(err, "warning: {}\n", one.text);
  for (RunWarning& one : list_balance_warnings(prepared.vehicle, resting, prepared.remarks))
    warnings.push_back(std::move(one));
  return warnings;
}

// Both bounds are of the vehicle in the equilibrium that the true one has, which the soft modes give at rest.
// Appends to `warnings` where the bounds are not proved.
FrequencyBracket calc_bracket(const PreparedRun& prepared, std::vector<RunWarning>& warnings) {
  if (!prepared.equilibrium->motion.is_rest())
    throw support::InputError({.path = "--bracket"},
                              "is for frequencies about rest, not about steady motion");
  const SoftTwin twin = make_soft_twin(prepared.vehicle, prepared.balance_model);
  for (const std::string& body : twin.unproved) {
    warnings.push_back(
        {"modes",
         {body},
         fmt::format("{}: the brackets are not proved: its superelement, of an earlier program, does not "
                     "say how the body deflects at rest; build it again",
                     body)});
  }
  const Eigen::VectorXd q = find_equilibrium(twin.model, insert_soft_modes(twin, prepared.equilibrium->q)).q;
  std::vector<bool> is_active = twin.is_soft;
  is_active.flip();
  const HeldModes stiffer = hold_modes(twin.model, is_active, q);
  UnknownMass unknown = make_unknown_mass(twin, q);
  for (Eigen::MatrixXd& mass : unknown.below) mass *= -1.0;
  return {
      .lower_hz = calc_frequency_bounds(twin.model, q, make_softening(twin), unknown.above)
                      .lower.cwiseMin(twin.highest_hz),  // beyond the band nothing is proved
      .upper_hz = calc_frequency_bounds(stiffer.model, select_active(stiffer, q), {}, unknown.below).upper,
      .highest_hz = twin.highest_hz};
}

// What axial forces at rest, which the brackets leave out, change in the frequencies, where that is more than
// the width of a bracket and than a thousandth.
void warn_of_axial_forces(const PreparedRun& prepared, const std::vector<VehicleMode>& modes,
                          const FrequencyBracket& bracket, std::vector<RunWarning>& warnings) {
  constexpr double kNoticeable = 1e-3;
  const auto warn = [&](std::string text) {
    warnings.push_back({"modes", {"frequencies"}, std::move(text)});
  };
  std::optional<Eigen::VectorXd> stiffened;
  try {
    stiffened = calc_stiffened_frequencies(prepared.vehicle, prepared.available,
                                           {prepared.level_road.get(), prepared.vehicle.direction, 0.0},
                                           prepared.equilibrium->q);
  } catch (const support::NumericalError&) {
    warn(
        "the brackets leave out axial forces at rest, with which no stable equilibrium was found: set "
        "stiffening of the flexible bodies");
  }
  if (!stiffened) return;
  double largest = 0.0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (!bracket.may_be_in_band(modes, k)) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const double change = std::abs((*stiffened)[i] / modes[k].undamped_frequency_hz - 1.0);
    const double width = bracket.upper_hz[i] / bracket.lower_hz[i] - 1.0;
    if (change <= std::max({width, kNoticeable, largest})) continue;
    largest = change;
    worst = k;
  }
  if (largest == 0.0) return;
  warn(fmt::format(
      "the brackets leave out axial forces at rest, which change frequencies by up to {:.2g} % (mode {}, to "
      "{:.5g} Hz), more than the bracket is wide: take the frequencies with stiffening of the flexible "
      "bodies",
      100.0 * largest, worst + 1, (*stiffened)[static_cast<Eigen::Index>(worst)]));
}

}  // namespace

int equilibrium_command(const RunRequest& request, bool json) {
  const PreparedRun prepared = prepare_run(request, Preparation::kBalance);
  const Model& model = prepared.balance_model;
  VehicleSections sections(prepared.vehicle, model);
  const RestingSections resting =
      calc_resting_sections(prepared.vehicle, model, *prepared.equilibrium, sections);
  const BalanceReport report{model,
                             prepared.vehicle,
                             *prepared.equilibrium,
                             prepared.assembly,
                             prepared.run.start == Run::Start::kSteady,
                             make_start_positions(model, prepared.vehicle),
                             &resting.loads,
                             report_warnings(prepared, resting, request.streams.err)};
  support::print(request.streams.out, "{}",
                 json ? format_report_json(request, "equilibrium", prepared, report.warnings,
                                           make_equilibrium_json(report))
                      : describe_static_lengths(prepared) + format_equilibrium(report));
  return support::kGood;
}

int modes_command(const RunRequest& request, const RunOutput& output) {
  const PreparedRun prepared = prepare_run(request, Preparation::kBalance);
  const Model& model = prepared.balance_model;
  const std::vector<VehicleMode> modes = calc_vehicle_modes(model, *prepared.equilibrium);
  VehicleSections sections(prepared.vehicle, model);
  const RestingSections resting =
      calc_resting_sections(prepared.vehicle, model, *prepared.equilibrium, sections);
  std::vector<RunWarning> warnings = report_warnings(prepared, resting, request.streams.err);
  warn_of_rounding(*prepared.equilibrium, warnings);
  warn_of_rounded_modes(model, modes, warnings);
  const std::vector<Kink> kinks = find_kinks_at_balance(prepared);
  warn_of_forces_at_rest(prepared, kinks, warnings);
  warn_of_lost_damping(prepared.vehicle, model, modes, warnings);
  std::optional<FrequencyBracket> bracket;
  if (output.bracket) {
    bracket = calc_bracket(prepared, warnings);
    warn_of_axial_forces(prepared, modes, *bracket, warnings);
  }
  if (output.json) {
    support::print(request.streams.out, "{}",
                   format_report_json(request, "modes", prepared, warnings,
                                      make_modes_json(model, prepared.vehicle, modes, resting.loads,
                                                      bracket ? &*bracket : nullptr)));
    return support::kGood;
  }
  support::print(request.streams.out, "{}",
                 format_modes(model, prepared.vehicle, modes, kinks, warnings,
                              prepared.run.start == Run::Start::kSteady));
  if (bracket)
    support::print(request.streams.out, "{}", format_bracket(prepared.vehicle, model, modes, *bracket));
  return support::kGood;
}

}  // namespace sprung::dynamics

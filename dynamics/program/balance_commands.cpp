#include <fmt/format.h>

#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/output/balance_report.h"
#include "dynamics/program/commands.h"
#include "tools/support/terminal/program.h"

namespace sprung::dynamics {

int equilibrium_command(const RunRequest& request, bool json) {
  const PreparedRun prepared = prepare_run(request, Preparation::kBalance);
  const Model& model = prepared.balance_model;
  const BalanceReport report{model,
                             prepared.vehicle,
                             *prepared.equilibrium,
                             prepared.assembly,
                             prepared.run.start == Run::Start::kSteady,
                             make_start_positions(model, prepared.vehicle)};
  fmt::print("{}", json ? format_equilibrium_json(report)
                        : describe_static_lengths(prepared) + format_equilibrium(report));
  return support::kGood;
}

int modes_command(const RunRequest& request, bool json) {
  const PreparedRun prepared = prepare_run(request, Preparation::kBalance);
  const std::vector<VehicleMode> modes = calc_vehicle_modes(prepared.balance_model, *prepared.equilibrium);
  fmt::print("{}", json ? format_modes_json(modes)
                        : format_modes(prepared.balance_model, prepared.vehicle, modes,
                                       prepared.run.start == Run::Start::kSteady));
  return support::kGood;
}

}  // namespace sprung::dynamics

#include <fmt/format.h>

#include "dynamics/output/choice_report.h"
#include "dynamics/program/commands.h"
#include "dynamics/program/model_report.h"
#include "tools/support/hdf5/foreign_file.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"

namespace sprung::dynamics {

namespace {

constexpr std::string_view kChoiceFormat = "sprung-mode-choice";

void write_choice_file(const std::filesystem::path& path, const PreparedRun& prepared,
                       const std::vector<std::string>& overrides) {
  support::Hdf5Writer file(path);
  file.attribute("/", "format", kChoiceFormat);
  file.attribute("/", "version", std::int64_t{1});
  file.attribute("/", "title", prepared.vehicle.name);
  file.attribute("/", "units", "SI");
  file.make_group("/model");
  file.attribute("/model", "speed", prepared.run.speed);
  file.write("/model/run_text", std::vector<std::string>{prepared.run.text});
  file.write("/model/vehicle_text", std::vector<std::string>{prepared.vehicle.text});
  file.write("/model/overrides", overrides);
  write_choice(file, "/model/mode_choice", *prepared.choice);
  file.commit();
}

}  // namespace

int select_modes_command(const RunRequest& request, const RunOutput& output) {
  if (support::is_foreign_file(output.results, kChoiceFormat)) {
    throw support::InputError(
        {.path = output.results.string()},
        "exists and is no file of chosen modes, so it is not overwritten; move it or name another with -o");
  }
  const PreparedRun prepared = prepare_run(request, Preparation::kChoice);
  if (!prepared.choice) {
    throw support::InputError({.path = request.run_file.string()},
                              "has no body with modes \"auto\", so there is nothing to choose");
  }
  if (!output.results.empty()) write_choice_file(output.results, prepared, request.overrides);
  support::print(request.streams.out, "{}",
                 output.json ? format_report_json(request, "select-modes", prepared,
                                                  list_file_warnings(prepared.remarks))
                             : format_choice(*prepared.choice));
  if (!output.results.empty() && !output.json)
    support::print(request.streams.out, "Choice: {}\n", output.results.string());
  return support::kGood;
}

}  // namespace sprung::dynamics

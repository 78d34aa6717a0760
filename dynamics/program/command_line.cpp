#include "dynamics/program/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "dynamics/program/commands.h"
#include "tools/support/terminal/print.h"

namespace sprung::dynamics {

namespace {

void add_input_options(CLI::App& command, RunRequest& request, RunOutput& output) {
  command.add_option("RUN.toml", request.run_file, "run file; it names the vehicle file")->required();
  command.add_option("--superelements", request.superelement_folder,
                     "folder of the superelements NAME.h5 (default: .)");
  command
      .add_option(
          "--set", request.overrides,
          "overrides a key: key.path=value of the run file, vehicle.key.path=value of the vehicle file; "
          "may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_flag("--json", output.json, "prints one JSON object (SI units) in place of tables");
  command.add_flag("--quiet", request.quiet, "no progress and no remarks on stderr");
}

// An empty name, as from an unset variable of a shell, is an error: the user wants a file.
void add_output_option(CLI::App& command, RunOutput& output, const char* what) {
  command
      .add_option("-o,--output", output.results, fmt::format("{} (HDF5); none is written without it", what))
      ->check(
          [](const std::string& name) { return name.empty() ? "must name a file, got an empty name" : ""; });
}

}  // namespace

int run_arguments(const std::vector<std::string>& arguments, RunRequest request) {
  CLI::App app{"Runs a vehicle of rigid and flexible bodies.", "sprung-dynamics"};
  app.failure_message([](const CLI::App* command, const CLI::Error& error) {
    return "sprung-dynamics: error: " + CLI::FailureMessage::simple(command, error);
  });
  app.footer(
      "Example: sprung-dynamics run dynamics/models/truck/bump.toml --superelements build/truck -o bump.h5 "
      "--set modes.chassis=4\n"
      "Exit codes: 0 good, 1 a check failed (results are written, but not to be trusted), 2 bad input, 3 "
      "numerics, 130 interrupted");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("sprung-dynamics ") + SPRUNG_VERSION);

  request.superelement_folder = ".";
  RunOutput output;
  CLI::App* run = app.add_subcommand("run", "static equilibrium, then the run; writes results and a summary");
  add_input_options(*run, request, output);
  add_output_option(*run, output, "results file");
  run->add_flag(
      "--resume", output.resume,
      "continues a run that was interrupted or killed from the last checkpoint in NAME.partial.h5; the "
      "results are those of a run without interruption");
  run->add_flag("--dry-run", output.dry_run,
                "prints what would be run: bodies, modes, joints, freedoms, equilibrium, size of the "
                "results; writes nothing");
  CLI::App* equilibrium = app.add_subcommand("equilibrium", "static equilibrium on level ground");
  add_input_options(*equilibrium, request, output);
  CLI::App* modes =
      app.add_subcommand("modes", "frequencies, damping and participating bodies about the equilibrium");
  add_input_options(*modes, request, output);
  modes->add_flag(
      "--bracket", output.bracket,
      "also prints, from the certificates of the flexible bodies, between which bounds each undamped "
      "frequency of the band lies");
  CLI::App* response = app.add_subcommand(
      "response",
      "frequency response to the road about the equilibrium; on a random road spectra and r.m.s.");
  add_input_options(*response, request, output);
  add_output_option(*response, output, "response file");
  CLI::App* select = app.add_subcommand(
      "select-modes",
      "effect of leaving out each mode under the run's forcing, and the modes that \"auto\" keeps");
  add_input_options(*select, request, output);
  add_output_option(*select, output, "file of the choice");

  try {
    app.parse(
        std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them from the end
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int code = app.exit(error, out, err);
    support::print(request.streams.out, "{}", out.str());
    support::print(request.streams.err, "{}", err.str());
    return code == 0 ? support::kGood : support::kBadInput;
  }
  if (*run) return run_command(request, output);
  if (*equilibrium) return equilibrium_command(request, output.json);
  if (*select) return select_modes_command(request, output);
  if (*response) return response_command(request, output);
  return modes_command(request, output);
}

}  // namespace sprung::dynamics

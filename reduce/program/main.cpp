#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <string>

#include "reduce/design/program_version.h"
#include "reduce/export/export.h"
#include "reduce/program/commands.h"
#include "tools/support/processes/large_heap.h"
#include "tools/support/terminal/program.h"

namespace {

using namespace sprung;

// What the command line asked for; filled by CLI11's callbacks.
struct Arguments {
  reduce::BuildOptions build;
  reduce::SensitivityOptions sensitivity;
  reduce::SweepCommand sweep;
  reduce::MatricesOptions matrices;
  reduce::ExportOptions exported;
  std::vector<std::filesystem::path> files;
  std::filesystem::path old_file, new_file;
  bool json = false;
};

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "Value in place of the design's: key.path=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_build(CLI::App& app, Arguments& arguments) {
  CLI::App* build =
      app.add_subcommand("build", "Make superelements from designs; what is up to date is left alone");
  build->add_option("designs", arguments.build.designs, "Design files (TOML)")->required();
  build->add_option("--output-dir,-o", arguments.build.output_dir, "Folder for the files, made if need be")
      ->capture_default_str();
  add_overrides(*build, arguments.build.overrides);
  build->add_flag("--force,-f", arguments.build.force, "Make them in any case, and replace foreign files");
  build->add_flag("--quiet,-q", arguments.build.quiet, "Print errors only");
  build->footer("Example: sprung-reduce build meshes/truck/*.toml --output-dir build/truck");
}

void add_inspections(CLI::App& app, Arguments& arguments) {
  CLI::App* info = app.add_subcommand("info", "Show what a superelement contains");
  info->add_option("file", arguments.new_file, "Superelement (HDF5)")->required();
  info->add_flag("--json", arguments.json, "As one JSON object");
  CLI::App* check = app.add_subcommand("check", "Verify superelements; exit code 1 if a check fails");
  check->add_option("files", arguments.files, "Superelements (HDF5)")->required();
  check->add_flag("--json", arguments.json, "As one JSON object for each file");
  CLI::App* diff = app.add_subcommand("diff", "Compare two superelements: frequencies and MAC");
  diff->add_option("old", arguments.old_file, "Superelement (HDF5)")->required();
  diff->add_option("new", arguments.new_file, "Superelement (HDF5)")->required();
  diff->add_flag("--json", arguments.json, "As one JSON object");
}

void add_sensitivity(CLI::App& app, reduce::SensitivityOptions& options) {
  CLI::App* sensitivity = app.add_subcommand(
      "sensitivity", "Show how frequencies, mass and flexibility change with the numbers of a design");
  sensitivity->add_option("design", options.design.path, "Design file (TOML)")->required();
  add_overrides(*sensitivity, options.design.overrides);
  sensitivity->add_option("--modes", options.num_modes, "Number of free and of clamped modes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sensitivity->add_flag("--json", options.json, "As one JSON object, derivatives in SI units");
  sensitivity->footer("Example: sprung-reduce sensitivity meshes/truck/chassis.toml");
}

void add_sweep(CLI::App& app, reduce::SweepCommand& command) {
  CLI::App* sweep =
      app.add_subcommand("sweep", "Follow the modes while a number of a design takes other values");
  sweep->add_option("design", command.design.path, "Design file (TOML)")->required();
  sweep->add_option("--vary", command.vary, "The number and its values: key.path=FROM:TO:STEPS")->required();
  add_overrides(*sweep, command.design.overrides);
  sweep->add_option("--modes", command.num_modes, "Number of free and of clamped modes")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sweep->add_flag("--preview", command.preview, "Solve the first value alone; for small changes");
  sweep->add_flag("--json", command.json, "As one JSON object");
  sweep->footer(
      "Example: sprung-reduce sweep meshes/truck/chassis.toml --vary "
      "sections.frame.second_moment=1e-4:3e-4:10");
}

void add_exports(CLI::App& app, Arguments& arguments) {
  CLI::App* matrices =
      app.add_subcommand("matrices", "Write stiffness and mass of a design's frame, not reduced");
  matrices->add_option("design", arguments.matrices.design.path, "Design file (TOML)")->required();
  add_overrides(*matrices, arguments.matrices.design.overrides);
  matrices->add_option("--prefix,-o", arguments.matrices.prefix, "Beginning of the files' names")->required();
  matrices->footer("Example: sprung-reduce matrices meshes/truck/chassis.toml -o build/chassis");
  CLI::App* exported = app.add_subcommand("export", "Write a superelement for another program");
  exported->add_option("file", arguments.exported.superelement, "Superelement (HDF5)")->required();
  exported->add_option("--to", arguments.exported.target, "Program or format")
      ->required()
      ->check(CLI::IsMember(reduce::list_export_targets()));
  exported->add_option("--prefix,-o", arguments.exported.prefix, "Beginning of the files' names")->required();
  exported->footer("Example: sprung-reduce export build/truck/chassis.h5 --to mbdyn -o build/chassis");
}

int run(const CLI::App& app, const Arguments& arguments) {
  if (app.got_subcommand("build")) return reduce::run_build(arguments.build);
  if (app.got_subcommand("sensitivity")) return reduce::run_sensitivity(arguments.sensitivity);
  if (app.got_subcommand("sweep")) return reduce::run_sweep(arguments.sweep);
  if (app.got_subcommand("matrices")) return reduce::run_matrices(arguments.matrices);
  if (app.got_subcommand("export")) return reduce::run_export(arguments.exported);
  if (app.got_subcommand("info")) return reduce::run_info(arguments.new_file, arguments.json);
  if (app.got_subcommand("check")) return reduce::run_check(arguments.files, arguments.json);
  return reduce::run_diff(arguments.old_file, arguments.new_file, arguments.json);
}

constexpr std::size_t kHeap = std::size_t{1} << 30U;  // bytes of address space, for files of large bodies

}  // namespace

int main(int argc, char** argv) {
  support::prepare_large_heap(kHeap);
  return support::run_program("sprung-reduce", [&]() -> int {
    CLI::App app("Reduces planar frames of beams to superelements for vehicle dynamics.", "sprung-reduce");
    app.set_version_flag("--version", std::string("sprung-reduce ") + reduce::get_program_version());
    app.require_subcommand(1);
    app.failure_message([](const CLI::App* command, const CLI::Error& error) {
      return "sprung-reduce: error: " + CLI::FailureMessage::simple(command, error);
    });
    Arguments arguments;
    add_build(app, arguments);
    add_sensitivity(app, arguments.sensitivity);
    add_sweep(app, arguments.sweep);
    add_inspections(app, arguments);
    add_exports(app, arguments);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? support::kGood : support::kBadInput;
    }
    return run(app, arguments);
  });
}

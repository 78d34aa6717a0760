#include <fmt/format.h>

#include <cstdio>
#include <map>

#include "reduce/design/design.h"
#include "reduce/design/design_remarks.h"
#include "reduce/inspection/certificate_tables.h"
#include "reduce/inspection/comparison.h"
#include "reduce/inspection/superelement_tables.h"
#include "reduce/matrices/ground.h"
#include "reduce/program/commands.h"
#include "reduce/program/previous_file.h"
#include "reduce/reduction/mesh_judgement.h"
#include "reduce/reduction/reduction.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/files/output_target.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"
#include "tools/support/terminal/progress_bar.h"

namespace sprung::reduce {

namespace {

namespace fs = std::filesystem;
using support::InputError;

// Progress goes to stdout line by line, so that a pipe sees it too.
void report(const BuildOptions& options, const std::string& text) {
  if (options.quiet) return;
  support::print(stdout, "{}\n", text);
  std::fflush(stdout);
}

// Design by its output file.
std::map<fs::path, fs::path> assign_outputs(const BuildOptions& options) {
  std::map<fs::path, fs::path> outputs;
  for (const fs::path& design : options.designs) {
    const fs::path output = options.output_dir / (design.stem().string() + ".h5");
    const auto [other, is_new] = outputs.emplace(output, design);
    if (is_new) continue;
    throw InputError({.path = design.string()},
                     fmt::format("would be written to '{}', as would '{}'; rename one", output.string(),
                                 other->second.string()));
  }
  return outputs;
}

void make_folder(const fs::path& folder) {
  std::error_code error, ignored;
  if (folder.extension() == ".h5" && !fs::is_directory(folder, ignored)) {
    throw InputError({.path = folder.string()},
                     "--output-dir got the name of a file, expected a folder: superelements have the names "
                     "of their designs");
  }
  fs::create_directories(folder, error);
  if (fs::is_directory(folder, ignored)) return;
  throw InputError({.path = folder.string()},
                   fmt::format("cannot be used as a folder for the superelements: {}",
                               error ? error.message() : "it is no folder"));
}

std::string describe_mass(const Superelement& s) {
  const Eigen::Vector2d centre = s.inertia.first_moment / s.inertia.mass;
  return fmt::format(
      "mass {:.6g} kg, moment of inertia {:.6g} kg·m² about its centre, which is ({:.4g}, {:.4g}) m "
      "from the reference",
      s.inertia.mass, s.inertia.second_moment - s.inertia.mass * centre.squaredNorm(), centre.x(),
      centre.y());
}

std::string describe(const Superelement& s) {
  if (s.elements.cols() == 0) {
    return fmt::format(
        "{} nodes, {} freedoms, {}; {}; matrices do not tell section loads, axial shares and geometric "
        "stiffness, so that the file has none",
        s.num_nodes(), s.num_elastic_dofs, format_basis(s), describe_mass(s));
  }
  return fmt::format("{} elements, {} freedoms, {}{}", s.elements.cols(), s.num_elastic_dofs, format_basis(s),
                     s.section_loads ? "" : ", too large for section loads from the loads");
}

// Why the file is to be made, "" if it is up to date.
std::string find_reason(const PreviousFile& previous, const fs::path& design, const fs::path& output,
                        const BuildOptions& options) {
  if (previous.foreign && !options.force) {
    throw InputError({.path = output.string()},
                     fmt::format("is in the way and is left alone; move it, or replace it with --force ({})",
                                 previous.reason));
  }
  if (!previous.exists) return "new";
  if (!previous.superelement) return fmt::format("the file there cannot be used: {}", previous.reason);
  const std::string reason = find_reason_to_rebuild(*previous.superelement, {design, options.overrides});
  return reason.empty() && options.force ? "forced" : reason;
}

void build_one(const fs::path& design, const fs::path& output, const BuildOptions& options) {
  support::remove_left_over(output);
  PreviousFile previous = read_previous_file(output);
  const std::string reason = find_reason(previous, design, output, options);
  if (previous.superelement) previous.superelement->resultants.resize(0, 0);  // large, and not compared
  if (reason.empty()) {
    report(options, fmt::format("{}: up to date", output.string()));
    return;
  }
  report(options, fmt::format("{}: building from {} ({})", output.string(), design.string(), reason));
  support::ProgressBar progress(output.filename().string(), options.quiet);
  const Design read = read_design({design, options.overrides});
  if (!support::is_plain_name(output.stem().string())) {
    report(options, fmt::format("{}: remark: no vehicle can name the superelement '{}': {}", design.string(),
                                output.stem().string(), kPlainNames));
  }
  for (const std::string& remark : list_design_remarks(read))
    report(options, fmt::format("{}: remark: {}", design.string(), remark));
  for (const std::string& remark : read.matrices ? read.matrices->remarks : std::vector<std::string>{})
    report(options, fmt::format("{}: remark: {}", design.string(), remark));
  const auto report_progress = [&](const std::string& state) { progress.update(state); };
  const Superelement made = make_superelement(read, {.progress = report_progress});
  report_progress("writing the file");
  write_superelement(made, output);
  progress.finish();
  report(options, fmt::format("{}: {}", output.string(), describe(made)));
  if (read.matrices) {
    const std::string remark = remark_on_ground(*read.matrices, made.frequency_hz(0));
    if (!remark.empty()) report(options, fmt::format("{}: remark: {}", design.string(), remark));
  }
  const double judged_hz = choose_judged_hz(read, made);
  for (const std::string& line : {format_certificate_line(made), describe_mesh(read, judged_hz)})
    if (!line.empty()) report(options, fmt::format("{}: {}", output.string(), line));
  if (const std::string remark = remark_on_mesh(read, judged_hz); !remark.empty())
    report(options, fmt::format("{}: remark: {}", design.string(), remark));
  if (previous.superelement && !options.quiet) {
    support::print(stdout, "{}", format_comparison(compare_modes(*previous.superelement, made)));
  }
}

void report_failure(const std::string& message) {
  std::fflush(stdout);
  support::print(stderr, "{}\n", message);
}

}  // namespace

int run_build(const BuildOptions& options) {
  const std::map<fs::path, fs::path> outputs = assign_outputs(options);
  make_folder(options.output_dir);
  int code = support::kGood;
  for (const fs::path& design : options.designs) {
    const fs::path output = options.output_dir / (design.stem().string() + ".h5");
    try {
      build_one(design, output, options);
    } catch (const InputError& error) {
      report_failure(error.what());
      if (code == support::kGood) code = support::kBadInput;
    } catch (const support::NumericalError& error) {
      report_failure(fmt::format("{}: error: {}", design.string(), error.what()));
      if (code == support::kGood) code = support::kNumerics;
    }
  }
  return code;
}

}  // namespace sprung::reduce

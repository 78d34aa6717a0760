#include "dynamics/program/results_names.h"

#include <fmt/format.h>

#include <system_error>

#include "dynamics/output/partial_results.h"
#include "dynamics/output/results_writer.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/foreign_file.h"

namespace sprung::dynamics {

namespace {

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code missing;
  return std::filesystem::equivalent(a, b, missing) && !missing;
}

}  // namespace

void check_results_name(const std::filesystem::path& results) {
  if (results.empty()) return;
  for (const std::filesystem::path& name : {results, partial_name(results)}) {
    if (support::is_foreign_file(name, kResultsFormat)) {
      throw support::InputError(
          {.path = name.string()},
          "exists and is no results file, so it is not overwritten; move it or name another with -o");
    }
  }
  if (results.extension() == ".partial" || results.stem().extension() == ".partial") {
    throw support::InputError({.path = results.string()},
                              "is a name of results that are not complete; name others with -o");
  }
}

void check_continued_file(const Run& run, const std::filesystem::path& results) {
  if (run.continue_from.empty() || results.empty()) return;
  for (const std::filesystem::path& name : {results, partial_name(results)}) {
    if (!is_same_file(run.continue_from, name)) continue;
    throw support::InputError(
        run.continue_location,
        fmt::format("{} is also the name of the results, or of their partial file, which would replace it; "
                    "name others with -o",
                    run.continue_from.string()));
  }
}

}  // namespace sprung::dynamics

// What a reduction cannot do without: assembling a frame's matrices, analysis and factors of the stiffness,
// solutions for a number of right-hand sides in blocks, and one count of the free modes. Prints a line of
// JSON with the CPU times; tools/benchmark reduce puts them beside those of whole builds.
//
//   factor_benchmark lattice.toml --columns 60 --count-below 12.5

#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numbers>
#include <string>

#include "reduce/modes/eigenvalue_count.h"
#include "reduce/reduction/body_basis.h"
#include "tools/support/terminal/program.h"

namespace {

using namespace sprung;

constexpr Eigen::Index kBlock = 24;  // right-hand sides that are solved together

double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

int run(int argc, char** argv) {
  std::string path;
  int num_columns = 60;
  double highest_hz = 0.0;
  CLI::App app("CPU times of factors, solutions and a count, as JSON: see tools/benchmark");
  app.add_option("design", path, "design file")->required();
  app.add_option("--columns", num_columns, "right-hand sides");
  app.add_option("--count-below", highest_hz, "of free modes, Hz")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? support::kGood : support::kBadInput;
  }
  const reduce::Design design = reduce::read_design(path);
  const double start = process_seconds();
  const reduce::BodyMatrices matrices = reduce::make_body_matrices(design);
  const double factored = process_seconds();
  const reduce::StiffnessFactor again(matrices.held.stiffness);
  const double factor_alone = process_seconds() - factored;
  const double begun = process_seconds();
  double sum = 0.0;
  for (Eigen::Index done = 0; done < num_columns; done += kBlock) {
    const Eigen::Index count = std::min(kBlock, num_columns - done);
    sum += matrices.factor->solve(Eigen::MatrixXd::Random(matrices.held.size(), count)).sum();
  }
  const double solved = process_seconds();
  const double omega = 2.0 * std::numbers::pi * highest_hz;
  const int counted = reduce::count_modes_below(matrices.free, omega * omega);
  fmt::print(
      R"({{"freedoms": {}, "assembly": {:.4f}, "factor": {:.4f}, "solutions": {:.4f}, "count": {:.4f}, )"
      R"("free_modes": {}, "checksum": {:.3e}}})"
      "\n",
      matrices.held.size(), factored - start - factor_alone, factor_alone, solved - begun,
      process_seconds() - solved, counted, sum);
  return support::kGood;
}

}  // namespace

int main(int argc, char** argv) {
  return sprung::support::run_program("factor_benchmark", [&] { return run(argc, argv); });
}

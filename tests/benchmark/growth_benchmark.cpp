// Cost of one evaluation and of one step against the number of bodies: an open chain of pendulums, and a
// closed chain like a track. Prints a line of JSON for each model; tools/benchmark makes a table of them.
//
//   growth_benchmark 10 100 1000

#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "dynamics/integration/integrator.h"
#include "dynamics/integration/partitioned/make_integrator.h"
#include "dynamics/integration/partitioned/partitioned_ode.h"
#include "tests/dynamics/chains.h"
#include "tools/support/terminal/program.h"

namespace {

using namespace sprung;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void benchmark_chain(const char* name, const test::Chain& chain, int num_steps) {
  const double before = thread_seconds();
  dynamics::PartitionedOde ode(chain.model);
  ode.set_state(chain.state, 0.0, 0.0);
  ode.make_state(0.0, ode.y());
  const double started = thread_seconds();
  const auto integrator = dynamics::make_integrator(
      ode, {.method = dynamics::Integrator::Method::kAdams, .relative_tolerance = 1e-6});
  integrator->start(0.0, ode.y(), 10.0);
  const long first = ode.num_derivatives();
  const double begun = thread_seconds();
  for (int i = 0; i < num_steps; ++i) integrator->step(1e-3);
  const double seconds = thread_seconds() - begun;
  const double num_evaluations = static_cast<double>(ode.num_derivatives() - first);
  fmt::print(
      R"({{"chain": "{}", "bodies": {}, "freedoms": {}, "factor_entries": {}, "seconds_to_start": {:.4e}, )"
      R"("seconds_per_evaluation": {:.4e}, "evaluations_per_step": {:.2f}, "seconds_per_step": {:.4e}}})"
      "\n",
      name, chain.model.bodies.size(), chain.model.num_freedoms(), ode.equations().num_factor_entries(),
      started - before, seconds / num_evaluations, num_evaluations / num_steps, seconds / num_steps);
}

int run(int argc, char** argv) {
  std::vector<int> sizes{10, 100, 1000};
  int num_steps = 50;
  CLI::App app(
      "Cost of an evaluation and of a step against the number of bodies, as JSON: see tools/benchmark");
  app.add_option("sizes", sizes, "numbers of bodies");
  app.add_option("--steps", num_steps, "that are timed");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? support::kGood : support::kBadInput;
  }
  for (const int size : sizes) benchmark_chain("open", test::make_open_chain(size), num_steps);
  for (const int size : sizes) benchmark_chain("closed", test::make_closed_chain(size), num_steps);
  return support::kGood;
}

}  // namespace

int main(int argc, char** argv) {
  return sprung::support::run_program("growth_benchmark", [&] { return run(argc, argv); });
}

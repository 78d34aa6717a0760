// Whole runs of the truck at several tolerances: their costs and their results. tools/benchmark compares the
// series with those of a converged run, and prints the costs.
//
//   run_benchmark RUN.toml SUPERELEMENTS --modes 2 --method adams --tolerance 1e-5 1e-6 --repetitions 5
//   --series FILE
//
// Prints a line of JSON for each tolerance. The time is that of this thread's own clock, for a run without
// outputs. FILE gets for each tolerance the run's samples one after the other, 4 doubles each: time, height
// and vertical acceleration of the chassis, front-end deflection, in SI units.

#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/preparation/prepared_run.h"
#include "dynamics/simulation/transient.h"
#include "tests/benchmark/dense_baseline.h"
#include "tools/support/terminal/program.h"

namespace {

using namespace sprung;

constexpr std::string_view kBaseline = "baseline";
constexpr double kLargestBaselineStep = 0.01;  // s: the truck's obstacles are longer at its speeds
constexpr double kOutputStep = 1e-3;           // s, of the series

struct Request {
  std::string run_file, superelements, method = "exponential", series;
  std::vector<double> tolerances{1e-6};
  int num_modes = 0, repetitions = 1;
  double duration = 0.0;  // s, 0: the run file's
};

using Row = std::array<double, 4>;

struct Cost {
  long evaluations = 0, steps = 0, rejected = 0, unsettled = 0, switches = 0;
};

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The values of the series, from the coordinates and their accelerations.
class Chassis {
 public:
  explicit Chassis(const dynamics::Model& model) {
    const int body = model.find_body("chassis"), marker = model.find_marker("chassis.front_end");
    if (body < 0 || marker < 0)
      throw std::invalid_argument("run_benchmark: the vehicle has no point chassis.front_end");
    first_ = model.bodies[static_cast<std::size_t>(body)].first_coordinate;
    front_end_ = model.markers[static_cast<std::size_t>(marker)].Phi.row(1);
  }
  Row row(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v_dot) const {
    return {time, q[first_ + 1], v_dot[first_ + 1], front_end_.dot(q.segment(first_ + 3, front_end_.size()))};
  }

 private:
  Eigen::Index first_;
  Eigen::RowVectorXd front_end_;
};

// Makes one run. @param series  receives the samples; null to measure the cost, without outputs
Cost run_once(const dynamics::PreparedRun& prepared, const Request& request, double tolerance,
              std::vector<Row>* series) {
  const Chassis chassis(prepared.model);
  const double duration = request.duration > 0.0 ? request.duration : prepared.run.duration;
  if (request.method == kBaseline) {
    benchmark::DenseBaseline baseline(prepared.model, prepared.start);
    benchmark::DenseBaseline::Output output;
    if (series) {
      output = [&](double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v_dot) {
        series->push_back(chassis.row(time, q, v_dot));
      };
    }
    const auto statistics = baseline.run(duration, tolerance, kLargestBaselineStep, kOutputStep, output);
    return {statistics.evaluations, statistics.steps, statistics.rejected, 0, 0};
  }
  dynamics::TransientOptions options;
  options.end_time = duration;
  options.output_step = series ? kOutputStep : duration;
  options.integrator = {.method = prepared.run.integrator.options.method, .relative_tolerance = tolerance};
  if (series) {
    options.on_output = [&](const dynamics::Snapshot& snapshot) {
      series->push_back(chassis.row(snapshot.time, snapshot.q, snapshot.v_dot));
    };
  }
  const dynamics::TransientStatistics statistics = run_transient(prepared.model, prepared.start, options);
  const auto& integrator = statistics.stepper.integrator;
  return {statistics.stepper.evaluations, integrator.steps, integrator.error_test_failures,
          integrator.iteration_failures, statistics.switches};
}

void benchmark_tolerance(const dynamics::PreparedRun& prepared, const Request& request, double tolerance,
                         std::ofstream& file) {
  if (file.is_open()) {
    std::vector<Row> series;
    run_once(prepared, request, tolerance, &series);
    file.write(reinterpret_cast<const char*>(series.data()),
               static_cast<std::streamsize>(series.size() * sizeof(Row)));
  }
  Cost cost;
  std::string seconds;
  for (int i = 0; i < request.repetitions; ++i) {
    const double start = thread_seconds();
    cost = run_once(prepared, request, tolerance, nullptr);
    seconds += fmt::format("{}{:.6e}", i > 0 ? ", " : "", thread_seconds() - start);
  }
  fmt::print(
      R"({{"method": "{}", "modes": {}, "tolerance": {:g}, "evaluations": {}, "steps": {}, "rejected": {}, "unsettled": {}, "switches": {}, "seconds": [{}]}})"
      "\n",
      request.method, request.num_modes, tolerance, cost.evaluations, cost.steps, cost.rejected,
      cost.unsettled, cost.switches, seconds);
}

int run(int argc, char** argv) {
  Request request;
  CLI::App app("Costs of whole runs of the truck, as JSON: see tools/benchmark");
  app.add_option("run", request.run_file, "run file")->required();
  app.add_option("superelements", request.superelements, "folder of the superelements")->required();
  app.add_option("--modes", request.num_modes, "chassis modes");
  app.add_option("--method", request.method, "an integrator, or baseline: dense equations, Dormand-Prince");
  app.add_option("--tolerance", request.tolerances, "relative tolerances");
  app.add_option("--repetitions", request.repetitions, "runs that are timed");
  app.add_option("--duration", request.duration, "end of the run, s");
  app.add_option("--series", request.series, "file for the samples");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? support::kGood : support::kBadInput;
  }
  std::vector<std::string> overrides{fmt::format("modes.chassis={}", request.num_modes)};
  if (request.method != kBaseline)
    overrides.push_back(fmt::format("integrator.method=\"{}\"", request.method));
  const dynamics::PreparedRun prepared = dynamics::prepare_run({.run_file = request.run_file,
                                                                .superelement_folder = request.superelements,
                                                                .overrides = overrides,
                                                                .quiet = true},
                                                               dynamics::Preparation::kRun);
  std::ofstream file;
  if (!request.series.empty()) file.open(request.series, std::ios::binary);
  for (const double tolerance : request.tolerances) benchmark_tolerance(prepared, request, tolerance, file);
  return file.good() ? support::kGood : support::kCheckFailed;
}

}  // namespace

int main(int argc, char** argv) {
  return sprung::support::run_program("run_benchmark", [&] { return run(argc, argv); });
}

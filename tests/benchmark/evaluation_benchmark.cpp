// One evaluation of the truck's equations of motion (positions of the dependents, velocities, accelerations),
// by the fast evaluator and by the plain dense one, with 0, 2, 4, 12 and 36 chassis modes. Compare ratios
// within one run: the machine's speed drifts. tools/benchmark prints them.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "dynamics/system/partitioned_equations.h"
#include "tests/dynamics/dense_evaluator.h"
#include "tests/dynamics/truck.h"

namespace {

using namespace sprung;

// The truck at rest on flat ground, and a small motion of its independent coordinates, so that Newton's
// method iterates.
struct Truck {
  explicit Truck(int num_modes) : at_rest(num_modes), fast(at_rest.model), plain(at_rest.model) {
    fast.choose_partition_at(0.0, at_rest.equilibrium.q);
    const std::vector<int>& independent = fast.partition().independent;
    for (const int i : independent) start.push_back(at_rest.equilibrium.q[i]);
    q_i = start;
    v_i.assign(independent.size(), 0.1);
    fast.update_positions(0.0, q_i);
    fast.update_velocities(v_i);
    branches.resize(static_cast<std::size_t>(at_rest.model.num_branches));
    fast.terms().choose_branches(branches);
    for (std::size_t k = 0; k < sines.size(); ++k) {
      sines[k] =
          std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sines.size()));
    }
    q = fast.q();
    v = fast.v();
  }
  // The change of a coordinate in a typical step.
  void move() {
    ++step;
    for (std::size_t k = 0; k < q_i.size(); ++k)
      q_i[k] = start[k] + 1e-4 * sines[(step + 10 * k) % sines.size()];
  }

  test::TruckAtRest at_rest;
  dynamics::PartitionedEquations fast;
  test::DenseEvaluator plain;
  std::vector<double> start, q_i, v_i;
  std::array<double, 63> sines{};
  std::vector<int> branches;
  Eigen::VectorXd q, v;
  std::size_t step = 0;
};

void fast_evaluation(benchmark::State& state) {
  Truck truck(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    truck.move();
    truck.fast.update_positions(0.0, truck.q_i);
    truck.fast.update_velocities(truck.v_i);
    truck.fast.update_accelerations(truck.branches);
    benchmark::DoNotOptimize(truck.fast.v_dot().data());
  }
}

void dense_evaluation(benchmark::State& state) {
  Truck truck(static_cast<int>(state.range(0)));
  const dynamics::Partition& partition = truck.fast.partition();
  for (auto _ : state) {
    truck.move();
    for (std::size_t k = 0; k < truck.q_i.size(); ++k) truck.q[partition.independent[k]] = truck.q_i[k];
    truck.plain.solve_positions(partition.dependent, truck.q);
    truck.plain.solve_velocities(partition.dependent, truck.q, truck.v);
    truck.plain.solve_accelerations(truck.q, truck.v);
    benchmark::DoNotOptimize(truck.plain.v_dot().data());
  }
}

BENCHMARK(fast_evaluation)->Arg(0)->Arg(2)->Arg(4)->Arg(12)->Arg(36)->Unit(benchmark::kMicrosecond);
BENCHMARK(dense_evaluation)->Arg(0)->Arg(2)->Arg(4)->Arg(12)->Arg(36)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();

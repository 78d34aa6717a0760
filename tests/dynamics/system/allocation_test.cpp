// No heap memory is asked for while the equations are evaluated: the truck's whole step loop, and the plain
// evaluator that stands beside it in comparisons.
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "dynamics/integration/generalized_alpha/generalized_alpha_stepper.h"
#include "dynamics/integration/partitioned/make_integrator.h"
#include "dynamics/integration/partitioned/partitioned_ode.h"
#include "dynamics/road/bump_road.h"
#include "tests/catch.h"
#include "tests/dynamics/allocation_counter.h"
#include "tests/dynamics/dense_evaluator.h"
#include "tests/dynamics/truck.h"

using namespace sprung;

TEST_CASE("The counter of allocations sees C++ and Eigen", "[truck]") {
  long before = test::num_allocations();
  std::vector<double> values(100, 1.0);
  CHECK(test::num_allocations() == before + 1);
  before = test::num_allocations();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(10, 10, values[3]);
  CHECK(test::num_allocations() == before + 1);
  matrix.resize(20, 20);
  CHECK(test::num_allocations() == before + 2);
}

TEST_CASE("Evaluating the truck's equations takes no memory", "[truck]") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = -30.0, .length = 60.0, .height = 0.1});
  const dynamics::Vehicle vehicle = test::read_truck();
  for (const int num_modes : {0, 2, 4, 12, 36}) {
    const dynamics::Model model = test::make_truck(vehicle, num_modes, {&road, -1.0, 0.0});
    const dynamics::State state{.time = 0.0,
                                .q = test::assemble_truck(model, vehicle),
                                .v = Eigen::VectorXd::Constant(model.num_coordinates, 0.1),
                                .branches = std::vector<int>(static_cast<std::size_t>(model.num_branches))};
    dynamics::PartitionedOde ode(model);
    ode.set_state(state, 0.0, 0.0);
    ode.make_state(0.0, ode.y());
    ode.piece().update_branches(ode.equations().terms());
    std::vector<double> y(ode.y().begin(), ode.y().end()), rate(y.size()), scales(y.size());
    std::vector<double> switches(static_cast<std::size_t>(ode.num_switches()));
    bool good = true;
    const long before = test::num_allocations();
    for (int i = 0; i < 50; ++i) {
      for (double& value : y) value += 1e-4;  // so that the dependents have to be found anew
      good &= ode.calc_derivative(0.0, y, rate);
      good &= ode.calc_switches(0.0, y, switches);
      ode.calc_error_scales(y, scales);
      good &= ode.piece().calc_longest_step(ode.equations().terms(), ode.equations().terms().time()) > 0.0 &&
              ode.equations().partition_decay() > 0.0;
    }
    const long taken = test::num_allocations() - before;
    INFO(num_modes << " modes");
    CHECK(good);
    CHECK(taken == 0);
  }
}

TEST_CASE("The plain evaluator takes no memory either", "[truck]") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = -30.0, .length = 60.0, .height = 0.1});
  const dynamics::Vehicle vehicle = test::read_truck();
  for (const int num_modes : {0, 4}) {
    const dynamics::Model model = test::make_truck(vehicle, num_modes, {&road, -1.0, 0.0});
    dynamics::PartitionedEquations equations(model);
    Eigen::VectorXd q = test::assemble_truck(model, vehicle), v = Eigen::VectorXd::Constant(q.size(), 0.1);
    equations.choose_partition_at(0.0, q);
    const dynamics::Partition partition = equations.partition();
    test::DenseEvaluator plain(model);
    bool good = true;
    const long before = test::num_allocations();
    for (int i = 0; i < 20; ++i) {
      for (const int k : partition.independent) q[k] += 1e-4;
      good &= plain.solve_positions(partition.dependent, q);
      plain.solve_velocities(partition.dependent, q, v);
      plain.solve_accelerations(q, v);
    }
    const long taken = test::num_allocations() - before;
    INFO(num_modes << " modes");
    CHECK(good);
    CHECK(taken == 0);
  }
}

TEST_CASE("Steps of the exponential integrator over the bump take no memory", "[truck]") {
  for (const int num_modes : {0, 4, 36}) {
    const test::BumpStart bump({.num_chassis_modes = num_modes});
    dynamics::PartitionedOde ode(bump.model);
    ode.set_state(bump.state, 0.0, 0.0);
    ode.make_state(0.0, ode.y());
    ode.piece().update_branches(ode.equations().terms());
    const auto integrator = make_integrator(ode, {.relative_tolerance = 1e-5});
    integrator->start(0.0, ode.y(), 1.0);
    integrator->step(1e-3);  // finds the modes of small motion, for which it does ask
    std::vector<double> y(ode.y().size());
    long taken = 0, steps = 0;
    while (integrator->time() < 1.0) {
      const long before = test::num_allocations();
      const dynamics::Integrator::StepResult result =
          integrator->step(ode.piece().calc_longest_step(ode.equations().terms(), integrator->time()));
      integrator->interpolate(integrator->time(), y);
      taken += test::num_allocations() - before;
      ++steps;
      if (result != dynamics::Integrator::StepResult::kSwitched) continue;
      ode.make_state(integrator->time(), y);
      ode.piece().update_branches(ode.equations().terms());
      integrator->start(integrator->time(), y, 1.0);
    }
    INFO(num_modes << " modes");
    CHECK(steps > 50);
    CHECK(taken == 0);
  }
}

TEST_CASE("Steps of generalized-α over the bump take no memory", "[truck]") {
  for (const int num_modes : {0, 4, 36}) {
    const test::BumpStart bump({.num_chassis_modes = num_modes});
    dynamics::GeneralizedAlphaStepper stepper(bump.model, 1e-4, {});
    stepper.start(bump.state);
    stepper.evaluate(0.0, dynamics::SystemStepper::Level::kAccelerations);
    stepper.piece().update_branches(stepper.equations().terms());
    stepper.resume(0.0, 0.6);
    stepper.step(1e-3);  // lists the entries of its matrix
    long taken = 0, steps = 0;
    while (stepper.time() < 0.6) {
      const long before = test::num_allocations();
      const dynamics::Integrator::StepResult result = stepper.step(stepper.calc_longest_step());
      stepper.evaluate(stepper.time(), dynamics::SystemStepper::Level::kAccelerations);
      taken += test::num_allocations() - before;
      ++steps;
      if (result != dynamics::Integrator::StepResult::kSwitched) continue;
      stepper.piece().update_branches(stepper.equations().terms());
      stepper.resume(stepper.time(), 0.6);
    }
    INFO(num_modes << " modes");
    CHECK(steps > 50);
    CHECK(taken == 0);
  }
}

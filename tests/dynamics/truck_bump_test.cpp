// The truck over the bump: whole runs of the solver.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/dense_evaluator.h"
#include "tests/dynamics/truck.h"

using namespace sprung;

TEST_CASE("The rigid truck over the bump", "[truck]") {
  const test::BumpResult run = test::drive_over_bump({.num_chassis_modes = 0});
  // An independent calculation with the same data
  CHECK(std::abs(run.lowest - -0.1003) < 1e-3);
  CHECK(std::abs(run.highest - 0.3724) < 1e-3);
  CHECK(run.largest_violation < 1e-9);
  CHECK(run.closure < 1e-6);
  REQUIRE(run.chassis.cols() == 5001);

  SECTION("is converged: with a hundredth of the tolerance no peak changes by a tenth of the margin") {
    const test::BumpResult fine = test::drive_over_bump({.num_chassis_modes = 0, .relative_tolerance = 1e-8});
    CHECK(std::abs(fine.lowest - run.lowest) < 1e-4);
    CHECK(std::abs(fine.highest - run.highest) < 1e-4);
    CHECK((fine.chassis - run.chassis).cwiseAbs().maxCoeff() < 1e-4);
    CHECK(fine.closure < 0.1 * run.closure);
  }
  SECTION("leaves the ground and touches it again, and reports both events") {
    int leaves = 0, touches = 0;
    for (const dynamics::Event& event : run.events) {
      leaves += event.text.ends_with("leaves the ground") ? 1 : 0;
      touches += event.text.ends_with("touches the ground") ? 1 : 0;
    }
    CHECK(leaves >= 2);
    CHECK(touches == leaves);
  }
}

TEST_CASE("The truck with 2 chassis modes over the bump", "[truck]") {
  const test::BumpResult run = test::drive_over_bump({.num_chassis_modes = 2});
  CHECK(std::abs(run.lowest - -0.0995) < 1e-3);
  CHECK(std::abs(run.highest - 0.3696) < 1e-3);
  CHECK(run.largest_violation < 1e-9);
  CHECK(run.closure < 1e-6);

  const test::BumpResult fine = test::drive_over_bump({.num_chassis_modes = 2, .relative_tolerance = 1e-7});
  CHECK(std::abs(fine.lowest - run.lowest) < 1e-4);
  CHECK(std::abs(fine.highest - run.highest) < 1e-4);
}

TEST_CASE("The truck with 4 chassis modes over the bump", "[truck]") {
  const test::BumpResult run = test::drive_over_bump({.num_chassis_modes = 4});
  CHECK(run.largest_violation < 1e-9);
  CHECK(run.closure < 1e-6);

  const test::BumpResult fine = test::drive_over_bump({.num_chassis_modes = 4, .relative_tolerance = 1e-7});
  CHECK((fine.chassis - run.chassis).cwiseAbs().maxCoeff() < 1e-4);
}

TEST_CASE("Three integrators take the truck over the bump alike", "[truck]") {
  for (const int num_modes : {0, 4}) {
    const test::BumpResult exponential =
        test::drive_over_bump({.num_chassis_modes = num_modes, .relative_tolerance = 1e-7, .duration = 2.0});
    for (const auto method : {dynamics::SteppingMethod::kAdams, dynamics::SteppingMethod::kBdf}) {
      const test::BumpResult other = test::drive_over_bump(
          {.num_chassis_modes = num_modes, .relative_tolerance = 1e-7, .duration = 2.0, .method = method});
      INFO(num_modes << " chassis modes");
      CHECK((other.chassis - exponential.chassis).cwiseAbs().maxCoeff() < 1e-7);
    }
  }
}

TEST_CASE("Generalized-α without a partition takes the truck over the bump alike", "[truck]") {
  for (const int num_modes : {2, 4}) {
    const test::BumpResult exponential =
        test::drive_over_bump({.num_chassis_modes = num_modes, .duration = 2.0});
    double last = 1.0;
    for (const double tolerance : {1e-4, 1e-6}) {
      const test::BumpResult other =
          test::drive_over_bump({.num_chassis_modes = num_modes,
                                 .relative_tolerance = tolerance,
                                 .duration = 2.0,
                                 .method = dynamics::SteppingMethod::kGeneralizedAlpha});
      const double difference = (other.chassis - exponential.chassis).cwiseAbs().maxCoeff();
      INFO(num_modes << " chassis modes, tolerance " << tolerance << ", difference " << difference);
      CHECK(difference < 0.1 * last);
      CHECK(other.closure < 3e-4);
      CHECK(other.largest_violation < 1e-9);
      last = difference;
    }
    CHECK(last < 1e-5);
  }
}

TEST_CASE("Generalized-α neither shakes stiff modes that its steps do not resolve, nor pays for them",
          "[truck]") {
  // An error of position in the highest mode, 4250 Hz, is 7e8 1/s² of it in the acceleration. Restarts from
  // such accelerations made vibrations: 1.5 m/s² and 6.1e4 evaluations at 1e-3, 7e4 evaluations at 1e-4.
  const test::BumpRun run{.num_chassis_modes = 36, .relative_tolerance = 1e-7};
  const test::BumpResult reference = test::drive_over_bump(run);
  for (const double tolerance : {1e-3, 1e-4}) {
    test::BumpRun other_run = run;
    other_run.relative_tolerance = tolerance;
    other_run.method = dynamics::SteppingMethod::kGeneralizedAlpha;
    const test::BumpResult other = test::drive_over_bump(other_run);
    const Eigen::VectorXd error = other.acceleration - reference.acceleration;
    const double mean = error.norm() / std::sqrt(static_cast<double>(error.size()));
    INFO("tolerance " << tolerance << ", root mean square " << mean << " m/s², largest "
                      << error.lpNorm<Eigen::Infinity>() << " m/s², closure " << other.closure
                      << ", evaluations " << other.statistics.stepper.evaluations);
    CHECK(mean < (tolerance > 5e-4 ? 1.0 : 0.3));
    CHECK(other.statistics.stepper.evaluations < (tolerance > 5e-4 ? 20'000 : 40'000));
  }
}

TEST_CASE("Stiff modes cost few additional evaluations: steps follow their excitation", "[truck]") {
  const auto evaluations = [](int num_modes) {
    const test::BumpResult run =
        test::drive_over_bump({.num_chassis_modes = num_modes, .relative_tolerance = 1e-3});
    return static_cast<double>(run.statistics.stepper.evaluations);
  };
  const double rigid = evaluations(0);
  CHECK(rigid < 4000);
  CHECK(evaluations(2) < 1.5 * rigid);
  CHECK(evaluations(4) < 2.2 * rigid);
  CHECK(evaluations(36) < 4.0 * rigid);  // up to 4250 Hz; by Adams 80 times
}

TEST_CASE("The mirrored truck driving the other way gives the mirrored result", "[truck]") {
  for (const int num_modes : {0, 2}) {
    const test::BumpResult run = test::drive_over_bump({.num_chassis_modes = num_modes});
    const test::BumpResult mirrored =
        test::drive_over_bump({.num_chassis_modes = num_modes, .mirrored = true});
    INFO(num_modes << " chassis modes");
    CHECK((mirrored.chassis - run.chassis).cwiseAbs().maxCoeff() < 1e-5);
  }
}

TEST_CASE("A run started a kilometre away gives the same result", "[truck]") {
  for (const int num_modes : {0, 2}) {
    const test::BumpResult run = test::drive_over_bump({.num_chassis_modes = num_modes});
    INFO(num_modes << " chassis modes");
    for (const double shift : {1000.0, -1000.0}) {
      const test::BumpResult far = test::drive_over_bump({.num_chassis_modes = num_modes, .shift = shift});
      CHECK((far.chassis - run.chassis).cwiseAbs().maxCoeff() < 1e-5);
    }
  }
}

TEST_CASE("The plain evaluator under a plain integrator drives the truck the same way", "[truck]") {
  // Everything computed a second time: dense equations, classical Runge–Kutta with a fixed step, no located
  // switches, no partition. Its error is that of stepping over kinks and jumps, of first order in the step.
  const test::BumpRun run{.num_chassis_modes = 2, .duration = 1.5};
  const test::BumpStart start(run);
  const test::BumpResult reference = test::drive_over_bump(run);
  const Eigen::Index chassis =
      start.model.bodies[static_cast<std::size_t>(start.model.find_body("chassis"))].first_coordinate;
  const double balance = start.rest.chassis()[1];
  constexpr int kStepsPerOutput = 10;
  constexpr double kStep = 1e-3 / kStepsPerOutput;
  test::DenseEvaluator plain(start.model);
  dynamics::PartitionedEquations equations(start.model);
  equations.choose_partition_at(0.0, start.state.q);
  const std::vector<int> dependent = equations.partition().dependent;

  Eigen::VectorXd q = start.state.q, v = start.state.v;
  const auto acceleration = [&](const Eigen::VectorXd& q_at, const Eigen::VectorXd& v_at) {
    plain.solve_accelerations(q_at, v_at);
    return Eigen::VectorXd(plain.v_dot());
  };
  bool closed = true;
  double difference = 0.0, highest = 0.0;
  for (Eigen::Index output = 1; output < reference.chassis.cols(); ++output) {
    for (int i = 0; i < kStepsPerOutput; ++i) {
      const Eigen::VectorXd a1 = acceleration(q, v);
      const Eigen::VectorXd v2 = v + 0.5 * kStep * a1, a2 = acceleration(q + 0.5 * kStep * v, v2);
      const Eigen::VectorXd v3 = v + 0.5 * kStep * a2, a3 = acceleration(q + 0.5 * kStep * v2, v3);
      const Eigen::VectorXd v4 = v + kStep * a3, a4 = acceleration(q + kStep * v3, v4);
      q += kStep / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
      v += kStep / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      closed &= plain.solve_positions(dependent, q);
      plain.solve_velocities(dependent, q, v);
    }
    difference = std::max(difference, std::abs(q[chassis + 1] - balance - reference.chassis(1, output)));
    highest = std::max(highest, q[chassis + 1] - balance);
  }
  CHECK(closed);
  CHECK(highest > 0.1);  // it has met the bump
  CHECK(difference < 3e-4);
}

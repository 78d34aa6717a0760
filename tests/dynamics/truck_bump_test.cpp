// The truck over the bump: whole runs of the solver.
#include <cmath>

#include "tests/catch.h"
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

  SECTION("is converged: a hundredth of the tolerance moves no peak by a tenth of what is asked") {
    const test::BumpResult fine = test::drive_over_bump({.num_chassis_modes = 0, .relative_tolerance = 1e-8});
    CHECK(std::abs(fine.lowest - run.lowest) < 1e-4);
    CHECK(std::abs(fine.highest - run.highest) < 1e-4);
    CHECK((fine.chassis - run.chassis).cwiseAbs().maxCoeff() < 1e-4);
    CHECK(fine.closure < 0.1 * run.closure);
  }
  SECTION("leaves the ground, comes down again, and says so") {
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

TEST_CASE("The mirrored truck driving the other way gives the mirrored result", "[truck]") {
  for (const int num_modes : {0, 2}) {
    const test::BumpResult run = test::drive_over_bump({.num_chassis_modes = num_modes});
    const test::BumpResult mirrored = test::drive_over_bump({.num_chassis_modes = num_modes, .mirrored = true});
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

#include "dynamics/bodies/body.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"

using namespace sprung;
using dynamics::Body;

TEST_CASE("A rigid body has mass and inertia and no modes", "[bodies]") {
  const Body body = dynamics::make_rigid_body("axle", 1185.0, 13.33);
  CHECK(body.name == "axle");
  CHECK(body.mass == 1185.0);
  CHECK(body.second_moment == 13.33);
  CHECK(body.first_moment.isZero(0.0));
  CHECK(body.num_modes() == 0);
  CHECK(body.num_coordinates() == 3);
  for (const double bad : {-1e-30, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK_THROWS_WITH(dynamics::make_rigid_body("axle", bad, 1.0), Contains("mass must be ≥ 0 kg"));
    CHECK_THROWS_WITH(dynamics::make_rigid_body("axle", 1.0, bad), Contains("inertia must be ≥ 0 kg·m²"));
  }
}

TEST_CASE("A flexible body takes the chosen modes' part of every invariant", "[bodies]") {
  const test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 6);
  const reduce::InertiaInvariants& all = frame.superelement.inertia;
  const Body body = dynamics::make_flexible_body("frame", frame.superelement, {2, 5});
  const std::vector<int> columns{1, 4};
  CHECK(body.num_coordinates() == 5);
  CHECK(body.mode_numbers == std::vector<int>{2, 5});
  CHECK(body.mass == all.mass);
  CHECK(body.first_moment == all.first_moment);
  CHECK(body.second_moment == all.second_moment);
  CHECK(body.P == all.P(Eigen::all, columns));
  CHECK(body.c == all.c(columns));
  CHECK(body.d == all.d(columns));
  CHECK(body.B == all.B(columns, columns));
  CHECK(body.M_ff == all.M_ff(columns, columns));
  CHECK(body.stiffness == frame.superelement.stiffness(columns, columns));
  CHECK(body.damping == frame.superelement.damping(columns, columns));
  for (int k = 0; k < 2; ++k) {
    double largest = 0.0;
    for (int node = 0; node < frame.superelement.num_nodes(); ++node) {
      largest = std::max(
          largest, std::hypot(frame.superelement.shapes(3 * node, columns[static_cast<std::size_t>(k)]),
                              frame.superelement.shapes(3 * node + 1, columns[static_cast<std::size_t>(k)])));
    }
    CHECK(body.mode_scale[k] == Approx(largest).epsilon(1e-14));
  }
}

TEST_CASE("A superelement without active modes is a rigid body with its mass, centre and inertia",
          "[bodies]") {
  const test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 3);
  const Body body = dynamics::make_flexible_body("frame", frame.superelement, {});
  CHECK(body.num_coordinates() == 3);
  CHECK(body.mass == frame.superelement.inertia.mass);
  CHECK(body.first_moment == frame.superelement.inertia.first_moment);
  CHECK(body.second_moment == frame.superelement.inertia.second_moment);
}

TEST_CASE("Modes that a superelement lacks are refused", "[bodies]") {
  const test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 3);
  for (const std::vector<int>& numbers : {std::vector<int>{0}, {4}, {-1}, {2, 2}, {3, 1}}) {
    CHECK_THROWS_WITH(dynamics::make_flexible_body("frame", frame.superelement, numbers),
                      Contains("mode numbers must ascend from 1 to 3"));
  }
}

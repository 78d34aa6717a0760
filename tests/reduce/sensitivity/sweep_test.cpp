#include "reduce/sensitivity/sweep.h"

#include <cmath>

#include "reduce/sensitivity/sweep_tables.h"
#include "tests/catch.h"
#include "tests/reduce/sensitivity/two_cantilevers.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {
namespace {

// The height of the second beam stays.
SweepOptions make_sweep(const std::string& key, std::vector<double> values) {
  testing::write_text("sweep.toml", make_cantilevers(0.03, 0.04));
  return {.design = {.path = "sweep.toml"}, .key = key, .values = std::move(values), .num_modes = 4};
}

// Expected: f ∝ h of the first beam's modes, while those of the second stay. They cross where both are equal,
// and there every basis of the pair is one; by their order two of them would have a kink.
TEST_CASE("modes are followed by their shapes through an exact crossing") {
  const SweepOptions options = make_sweep("sections.first.height", {0.03, 0.035, 0.04, 0.045, 0.05});
  const std::vector<SweepPoint> points = calc_sweep(options);
  REQUIRE(points.size() == 5);
  const Eigen::VectorXd begin = points.front().clamped.hz;
  for (const SweepPoint& point : points) {
    const double scale = point.value / 0.03;
    CHECK(point.clamped.hz(0) == Approx(scale * begin(0)).epsilon(1e-8));
    CHECK(point.clamped.hz(1) == Approx(begin(1)).epsilon(1e-8));
    CHECK(point.clamped.hz(2) == Approx(scale * begin(2)).epsilon(1e-8));
    CHECK(point.clamped.hz(3) == Approx(begin(3)).epsilon(1e-8));
    CHECK(point.clamped.correlation.minCoeff() > 0.99);
    CHECK(point.mass == Approx(7850.0 * 0.05 * 2.0 * (point.value + 0.04)).epsilon(1e-9));
  }
  CHECK(points.back().clamped.hz(0) > points.back().clamped.hz(1));
  CHECK_THAT(format_sweep(options, points), Contains("mode 4 Hz") && Contains("0.045"));
  CHECK_THAT(format_sweep_json(options, points), Contains("\"correlation\""));
}

// With three modes the second mode of the second beam, f ∝ h, is above them at first, 6.27 · 0.04 beside 6.27
// · 0.03, and comes down below the second mode of the first beam.
TEST_CASE("a mode that comes down below those that are followed is told of, and only then") {
  SweepOptions options = make_sweep("sections.second.height", {0.04, 0.035});
  options.num_modes = 3;
  std::vector<SweepPoint> points = calc_sweep(options);
  for (const SweepPoint& point : points) CHECK_FALSE(point.clamped.is_passed);
  for (SweepPoint& point : points) point.free.is_passed = false;
  CHECK_THAT(format_sweep(options, points), !Contains("came down"));
  options.values = {0.04, 0.02};
  points = calc_sweep(options);
  CHECK_FALSE(points.front().clamped.is_passed);
  CHECK(points.back().clamped.is_passed);
  CHECK_THAT(format_sweep(options, points), Contains("came down from above"));
}

// A pair in another basis is the same pair: rotated back it continues the modes without a change.
TEST_CASE("the basis of a cluster is rotated to the modes that continue in it") {
  const Design design = read_design(make_sweep("sections.first.height", {}).design);
  const BodyMatrices matrices = make_body_matrices(design);
  BodyModes modes = calc_body_modes(design, matrices, false, 5);
  const TrackedModes from{.hz = modes.calc_hz().head(3),
                          .correlation = Eigen::Vector3d::Ones(),
                          .shapes = modes.shapes.leftCols(3)};
  modes.cluster << 1, 1, 2, 2, 3;
  Eigen::Matrix2d rotation;
  rotation << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  modes.shapes.leftCols(2) = (modes.shapes.leftCols(2) * rotation).eval();
  modes.shapes.middleCols(2, 2) = (modes.shapes.middleCols(2, 2) * rotation).eval();
  const TrackedModes to = continue_modes(from, modes, matrices.full.mass);
  CHECK((to.shapes - from.shapes).norm() < 1e-9 * from.shapes.norm());
  CHECK((to.correlation.array() - 1.0).abs().maxCoeff() < 1e-9);
}

TEST_CASE("values that make no design, or another mesh, are refused") {
  const auto message = [](const std::string& key, std::vector<double> values) {
    return testing::message_of<support::InputError>([&] { calc_sweep(make_sweep(key, values)); });
  };
  CHECK_THAT(message("lines.0.elements", {12, 13}),
             Contains("'lines.0.elements' = 13 gives the frame another number of nodes"));
  CHECK_THAT(message("sections.first.height", {0.03, -0.01}), Contains("sections.first.height"));
}

}  // namespace
}  // namespace sprung::reduce

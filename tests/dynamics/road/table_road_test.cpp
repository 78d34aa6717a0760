#include "dynamics/road/table_road.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/catch.h"

using namespace sprung;
using dynamics::TableRoad;

namespace {

const std::vector<double> kDistance{10.0, 10.4, 11.0, 11.3, 12.0};
const std::vector<double> kHeight{0.0, 0.12, -0.05, 0.02, 0.07};

}  // namespace

TEST_CASE("A table road passes through its points from its start on, level before and behind", "[road]") {
  const TableRoad road(3.0, kDistance,
                       kHeight);  // distances count from any origin: here the first is at 10 m
  for (std::size_t i = 0; i < kDistance.size(); ++i) {
    CHECK(road.height(3.0 + kDistance[i] - 10.0) == Approx(kHeight[i]).margin(1e-14));
  }
  REQUIRE(road.num_segments() == 3);
  CHECK(road.segment_end(0) == 3.0);
  CHECK(road.segment_end(1) == Approx(5.0).epsilon(1e-15));
  CHECK(road.height(-20.0) == 0.0);
  CHECK(road.height(2.999) == 0.0);
  CHECK(road.height(5.001) == 0.07);
  CHECK(road.height(500.0) == 0.07);
  // No kink where the table begins and ends
  CHECK(road.sample(1, 3.0).slope == Approx(0.0).margin(1e-14));
  CHECK(road.sample(1, road.segment_end(1)).slope == Approx(0.0).margin(1e-13));
  CHECK(road.sample(0, 2.0).slope == 0.0);
  CHECK(road.sample(2, 7.0).slope == 0.0);
}

TEST_CASE("A table road's slope is the derivative of its height", "[road]") {
  const TableRoad road(3.0, kDistance, kHeight);
  constexpr double kStep = 1e-6;
  for (double s = 3.01; s < 4.99; s += 0.013) {
    const double difference = (road.height(s + kStep) - road.height(s - kStep)) / (2.0 * kStep);
    CHECK(road.sample(road.find_segment(s, true), s).slope == Approx(difference).margin(1e-8));
  }
}

TEST_CASE("A table road's detail is the distance of its points near a wheel, on either side", "[road]") {
  const TableRoad road(3.0, kDistance, kHeight);                   // points at 3, 3.4, 4, 4.3 and 5 m
  CHECK(road.resolution(1, 3.05) == Approx(0.38).epsilon(1e-12));  // 0.4 of the way to the closest points
  CHECK(road.resolution(1, 3.2) == Approx(0.32).epsilon(1e-12));
  CHECK(road.resolution(1, 4.1) == Approx(0.3).epsilon(1e-12));
  CHECK(road.resolution(1, 4.9) == Approx(0.3).epsilon(1e-12));  // 0.4 of the way back is less
  CHECK(road.finest_resolution(1) == Approx(0.3).epsilon(1e-12));
  CHECK(road.resolution(0, 1.0) == std::numeric_limits<double>::infinity());
  CHECK(road.resolution(2, 9.0) == std::numeric_limits<double>::infinity());
}

TEST_CASE("Two close points of a table road concern wheels near them only", "[road]") {
  const std::vector<double> s{0.0, 5.0, 5.0 + 1e-6, 10.0, 30.0}, height{0.0, 0.0, 0.01, 0.01, 0.0};
  const TableRoad road(1.0, s, height);
  CHECK(road.resolution(1, 6.0) == Approx(1e-6).epsilon(1e-3));
  CHECK(road.resolution(1, 5.0) == Approx(0.4).epsilon(1e-3));   // 1 m before them
  CHECK(road.resolution(1, 9.0) == Approx(1.2).epsilon(1e-3));   // 3 m behind them
  CHECK(road.resolution(1, 25.0) == Approx(5.6).epsilon(1e-3));  // 14 m behind the interval of 5 m
  CHECK(road.finest_resolution(1) == Approx(1e-6).epsilon(1e-3));
}

TEST_CASE("A table that is no road is refused", "[road]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(TableRoad(0.0, std::array{1.0}, std::array{0.0}), Contains("at least 2 points"));
  CHECK_THROWS_WITH(TableRoad(0.0, std::array{1.0, 2.0}, std::array{0.0}), Contains("at least 2 points"));
  CHECK_THROWS_WITH(TableRoad(0.0, std::array{1.0, 2.0}, std::array{0.1, 0.2}),
                    Contains("the first height must be 0 m, as the road before it, got 0.1"));
  CHECK_THROWS_WITH(TableRoad(0.0, std::array{1.0, 2.0}, std::array{nan, 0.2}),
                    Contains("the first height must be 0 m"));
  CHECK_THROWS_WITH(TableRoad(0.0, std::array{1.0, 1.0}, std::array{0.0, 0.2}), Contains("x must ascend"));
  CHECK_THROWS_AS(TableRoad(0.0, std::array{2.0, 1.0}, std::array{0.0, 0.2}), std::invalid_argument);
}

#include "dynamics/road/road_spectrum.h"

#include <array>
#include <limits>

#include "tests/catch.h"

using namespace sprung;
using dynamics::RoadSpectrum;

TEST_CASE("ISO 8608 classes are four times rougher each", "[road]") {
  // Geometric means of ISO 8608:2016, table C.1 [1e-6 m³].
  const std::array<double, 8> densities{16, 64, 256, 1024, 4096, 16384, 65536, 262144};
  for (std::size_t k = 0; k < densities.size(); ++k) {
    CHECK(dynamics::calc_iso_density(static_cast<char>('A' + k)) ==
          Approx(1e-6 * densities[k]).epsilon(1e-14));
  }
  CHECK_THROWS_WITH(dynamics::calc_iso_density('I'), Contains("got 'I'"));
}

TEST_CASE("A power law at all wavenumbers, until it is cut to a band", "[road]") {
  RoadSpectrum road = RoadSpectrum::power_law(64e-6, 2.5);
  CHECK(road.density(0.1) == Approx(64e-6).epsilon(1e-13));
  CHECK(road.density(10.0) == Approx(64e-6 * 1e-5).epsilon(1e-12));
  CHECK(road.density(0.001) == Approx(64e-6 * 1e5).epsilon(1e-12));
  CHECK(road.breaks().empty());
  road.limit_to(0.02, 3.0);
  CHECK(road.density(0.019) == 0.0);
  CHECK(road.density(0.02) > 0.0);
  CHECK(road.density(3.01) == 0.0);
  CHECK(road.breaks() == std::vector<double>{0.02, 3.0});
}

TEST_CASE("Between points a spectrum is linear in logarithms, beyond them it is zero", "[road]") {
  RoadSpectrum road = RoadSpectrum::through_points(std::array{0.01, 0.1, 10.0}, std::array{1e-3, 1e-4, 1e-8});
  CHECK(road.density(0.1) == Approx(1e-4).epsilon(1e-12));
  CHECK(road.density(1.0) == Approx(1e-6).epsilon(1e-12));  // half way down a slope of −2
  CHECK(road.density(0.02) == Approx(1e-3 / 2.0).epsilon(1e-12));
  CHECK(road.density(0.0099) == 0.0);
  CHECK(road.density(10.1) == 0.0);
  REQUIRE(road.breaks().size() >= 3);
  road.limit_to(0.05, std::numeric_limits<double>::infinity());
  CHECK(road.density(0.04) == 0.0);
  CHECK(road.breaks().front() == 0.05);
}

TEST_CASE("An impossible road spectrum is refused", "[road]") {
  CHECK_THROWS_WITH(RoadSpectrum::power_law(0.0, 2.0), Contains("density must be > 0 m³"));
  CHECK_THROWS_WITH(RoadSpectrum::through_points(std::array{0.1}, std::array{1.0}),
                    Contains("2 points or more"));
  CHECK_THROWS_WITH(RoadSpectrum::through_points(std::array{0.1, 0.1}, std::array{1.0, 1.0}),
                    Contains("must ascend"));
  CHECK_THROWS_WITH(RoadSpectrum::through_points(std::array{0.1, 0.2}, std::array{1.0, 0.0}),
                    Contains("be > 0 m³"));
  RoadSpectrum road = RoadSpectrum::power_law(1e-6, 2.0);
  CHECK_THROWS_WITH(road.limit_to(1.0, 0.5), Contains("got 1 to 0.5"));
}

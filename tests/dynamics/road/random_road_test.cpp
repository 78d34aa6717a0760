#include "dynamics/road/random_road.h"

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/catch.h"

using namespace sprung;
using dynamics::RandomRoad;

namespace {

RandomRoad make_road(double rms = 0.0) {
  return {.spectrum = dynamics::RoadSpectrum::power_law(256e-6, 2.0),
          .lowest = 0.1,
          .highest = 0.3,
          .length = 10.0,
          .rms = rms};
}

double calc_rms(const std::vector<double>& heights, double level = 0.0) {
  double sum = 0.0;
  for (const double height : heights) sum += (height - level) * (height - level);
  return std::sqrt(sum / static_cast<double>(heights.size()));
}

}  // namespace

TEST_CASE("A random road is the sum of its waves, with the phases that Python draws", "[road]") {
  // The first numbers of random.Random(seed).random() in Python 3.11; the amplitudes are sqrt(2 G(n)/L).
  const auto [seed, drawn] = GENERATE(
      std::pair(std::uint64_t{1}, std::array{0.13436424411240122, 0.8474337369372327, 0.763774618976614}),
      std::pair((std::uint64_t{1} << 40) + 3,
                std::array{0.21978710637116716, 0.5494687768352203, 0.09461190973523603}));
  RandomRoad road = make_road();
  road.seed = seed;
  const std::vector<double> heights = dynamics::make_random_heights(road);
  REQUIRE(heights.size() >= 6 * 3 + 1);
  const auto wave_sum = [&, &phases = drawn](double s) {
    double sum = 0.0;
    for (int k = 1; k <= 3; ++k) {
      const double n = 0.1 * k, density = 256e-6 * std::pow(n / 0.1, -2.0);
      const double phase = 2.0 * std::numbers::pi * phases[static_cast<std::size_t>(k - 1)];
      sum += std::sqrt(2.0 * density / 10.0) * std::cos(2.0 * std::numbers::pi * n * s + phase);
    }
    return sum;
  };
  const double spacing = 10.0 / static_cast<double>(heights.size() - 1);
  for (std::size_t i = 0; i < heights.size(); ++i)
    CHECK(heights[i] == Approx(wave_sum(spacing * static_cast<double>(i)) - wave_sum(0.0)).margin(1e-14));
}

TEST_CASE("A random road has the r.m.s. height that is asked for, and eased ends at zero", "[road]") {
  RandomRoad road = make_road(0.02);
  std::vector<double> heights = dynamics::make_random_heights(road);
  const double mean =
      std::accumulate(heights.begin(), heights.end(), 0.0) / static_cast<double>(heights.size());
  CHECK(calc_rms(heights, mean) == Approx(0.02).epsilon(1e-13));
  CHECK(heights.front() == 0.0);
  CHECK(std::abs(mean) > 1e-3);  // where the profile begins is no part of its r.m.s.
  road.ease = 2.0;
  heights = dynamics::make_random_heights(road);
  CHECK(calc_rms(heights) == Approx(0.02).epsilon(1e-13));
  CHECK(heights.front() == 0.0);
  CHECK(heights.back() == 0.0);
}

TEST_CASE("A random road without waves, with too many points or without height is refused", "[road]") {
  RandomRoad road = make_road();
  road.highest = 0.19;
  road.lowest = 0.11;
  CHECK_THROWS_WITH(dynamics::make_random_heights(road),
                    Contains("from 0.11 to 0.19 1/m holds no multiple of 1/10 m"));
  road.length = 1e9;
  CHECK_THROWS_WITH(dynamics::make_random_heights(road), Contains("need 1.14e+09 points, more than 1e+07"));
  road = make_road();
  road.spectrum = dynamics::RoadSpectrum::power_law(1e308, 300.0);
  CHECK_THROWS_WITH(dynamics::make_random_heights(road), Contains("r.m.s. value of"));
  CHECK_THROWS_WITH(dynamics::make_random_heights(make_road(1e300)),
                    Contains("of 1e+300 m, expected up to 1000 m"));
}

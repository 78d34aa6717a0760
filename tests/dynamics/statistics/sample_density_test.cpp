#include "dynamics/statistics/sample_density.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/catch.h"

namespace {

using namespace sprung::dynamics;

constexpr double kFloor = 1e-6;

SampleDensity make_sine(double samples_per_period, double offset) {
  SampleDensity density;
  for (int i = 0; i < 2000; ++i)
    density.add_sample(offset + std::sin(2.0 * std::numbers::pi * i / samples_per_period + 0.3));
  return density;
}

TEST_CASE("the roughness of a sine is that of its samples per period (statistics, eq. 2)") {
  for (const double p : {2.3, 4.7, 7.1, 30.0}) {
    const double cosine = std::cos(2.0 * std::numbers::pi / p);
    const double expected = 2.0 / 3.0 * (1.0 - cosine) * (1.0 - cosine);
    CHECK(make_sine(p, 0.0).roughness(kFloor) == Approx(expected).epsilon(2e-3));
    CHECK(make_sine(p, 5.0).roughness_by_steps(kFloor) ==
          Approx(expected).epsilon(2e-3));  // (statistics, eq. 3)
  }
  // A constant is smooth, and part of the size: the mean square is 9.5.
  CHECK(make_sine(4.0, 3.0).roughness(kFloor) == Approx(2.0 / 3.0 * std::sqrt(0.5 / 9.5)).epsilon(2e-3));
}

TEST_CASE("a change of level does not hide a vibration from the roughness by steps") {
  SampleDensity density;
  for (int i = 0; i < 200; ++i)
    density.add_sample(std::min(i, 50) + (i > 100 ? std::sin(2.0 * std::numbers::pi * i / 3.3) : 0.0));
  CHECK(density.roughness(kFloor) < 0.05);
  CHECK(density.roughness_by_steps(kFloor) > 0.4);
  SampleDensity level;
  for (int i = 0; i < 100; ++i) level.add_sample(i < 50 ? 1.0 : 1.0 + 1e-9 * (i % 2));
  CHECK(level.roughness_by_steps(kFloor) < 0.01);
}

TEST_CASE("four samples, and samples below the floor, are not called rough") {
  SampleDensity few, small;
  for (const double value : {1.0, -1.0, 1.0, -1.0}) few.add_sample(value);
  CHECK(few.roughness(kFloor) == 0.0);
  for (int i = 0; i < 100; ++i) small.add_sample(i % 2 == 0 ? 1e-9 : -1e-9);
  CHECK(small.roughness(kFloor) < 0.01);
}

TEST_CASE("a jump at the last sample is not called rough") {
  SampleDensity density;
  for (int i = 0; i < 1000; ++i) density.add_sample(0.0);
  density.add_sample(15.0);
  CHECK(density.roughness(kFloor) < 0.4);
}

TEST_CASE("a value between samples counts where it lies outside of their range") {
  SampleDensity density;
  for (const double value : {-4.0, 1.0, 3.0}) density.add_sample(value);
  CHECK(density.missed(kFloor) == 0.0);
  density.add_between(2.0);
  CHECK(density.missed(kFloor) == 0.0);
  density.add_between(3.5);
  density.add_between(-8.0);
  CHECK(density.missed(kFloor) == Approx(0.5));
  CHECK(density.farthest_between() == -8.0);
}

}  // namespace

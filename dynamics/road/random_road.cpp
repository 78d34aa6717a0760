#include "dynamics/road/random_road.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <random>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

namespace sprung::dynamics {

namespace {

constexpr double kPointsOnWave = 6.0;  // the spline through them is 1.6 % of the amplitude off
constexpr double kMostPoints = 1e7;
constexpr double kLargestRms = 1e3;  // m
constexpr double kWhole = 1e-9;      // a number of waves this near to a whole one counts as that

// Begins a Mersenne Twister as Python's `random.Random(seed)` does, by an array of 32-bit words, of which a
// seed below 2⁶⁴ has one or two: init_by_array of [Matsumoto & Nishimura 1998].
class PythonSeed {
 public:
  using result_type = std::uint32_t;
  explicit PythonSeed(std::uint64_t seed)
      : words_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

  template <class Iterator>
  void generate(Iterator state, Iterator end) const {
    const std::ptrdiff_t size = end - state;
    state[0] = 19650218U;
    const auto mix = [&](std::ptrdiff_t at) { return state[at - 1] ^ (state[at - 1] >> 30); };
    for (std::ptrdiff_t at = 1; at < size; ++at)
      state[at] = 1812433253U * mix(at) + static_cast<std::uint32_t>(at);
    std::ptrdiff_t i = 1;
    const auto advance = [&] {
      if (++i < size) return;
      state[0] = state[size - 1];
      i = 1;
    };
    const std::uint32_t num_words = words_[1] == 0 ? 1 : 2;
    for (std::uint32_t k = 0; k < size; ++k, advance())
      state[i] = (state[i] ^ (mix(i) * 1664525U)) + words_[k % num_words] + k % num_words;
    for (std::uint32_t k = 1; k < size; ++k, advance())
      state[i] = (state[i] ^ (mix(i) * 1566083941U)) - static_cast<std::uint32_t>(i);
    state[0] = 0x80000000U;
  }

 private:
  std::array<std::uint32_t, 2> words_;
};

// A random number from 0 to 1 of 53 bits.
double draw(std::mt19937& generator) {
  const auto high = generator() >> 5, low = generator() >> 6;
  return (static_cast<double>(high) * 67108864.0 + static_cast<double>(low)) / 9007199254740992.0;
}

// Products of 2, 3 and 5, for which the Fourier transform is fast.
bool is_smooth(std::size_t n) {
  for (const std::size_t factor : {2, 3, 5}) {
    while (n % factor == 0) n /= factor;
  }
  return n == 1;
}

double calc_easing(double from_end, double ease) {
  return from_end < ease ? 0.5 - 0.5 * std::cos(std::numbers::pi * from_end / ease) : 1.0;
}

}  // namespace

std::vector<double> make_random_heights(const RandomRoad& road) {
  const double points = kPointsOnWave * road.highest * road.length;
  if (!(points < kMostPoints)) {
    throw std::invalid_argument(fmt::format("{} m with waves up to {} 1/m need {:.3g} points, more than {:g}",
                                            road.length, road.highest, points, kMostPoints));
  }
  const auto first =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(road.lowest * road.length - kWhole)));
  const auto last = static_cast<std::int64_t>(std::floor(road.highest * road.length + kWhole));
  if (last < first) {
    throw std::invalid_argument(fmt::format("the band from {} to {} 1/m holds no multiple of 1/{} m",
                                            road.lowest, road.highest, road.length));
  }
  auto num_parts = static_cast<std::size_t>(std::ceil(points));
  while (!is_smooth(num_parts)) ++num_parts;
  std::vector<std::complex<double>> waves(num_parts), periodic;
  PythonSeed seed(road.seed);
  std::mt19937 generator(seed);
  for (std::int64_t k = first; k <= last; ++k) {
    const double n = std::clamp(static_cast<double>(k) / road.length, road.lowest, road.highest);
    const double amplitude = std::sqrt(2.0 * road.spectrum.density(n) / road.length);
    waves[static_cast<std::size_t>(k)] = std::polar(amplitude, 2.0 * std::numbers::pi * draw(generator));
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::Unscaled);
  transform.inv(periodic, waves);

  std::vector<double> heights(num_parts + 1);
  const double spacing = road.length / static_cast<double>(num_parts);
  // The waves have no mean over a period, of which the last point is one too many. Eased ends are at 0.
  const double level = road.ease > 0.0 ? 0.0 : periodic[0].real() / static_cast<double>(heights.size());
  double sum = 0.0;
  for (std::size_t i = 0; i <= num_parts; ++i) {
    const double from_end = spacing * static_cast<double>(std::min(i, num_parts - i));
    heights[i] = periodic[i % num_parts].real() * calc_easing(from_end, road.ease);
    sum += (heights[i] - level) * (heights[i] - level);
  }
  const double found = std::sqrt(sum / static_cast<double>(heights.size()));
  const double wanted = road.rms > 0.0 ? road.rms : found;
  if (!(found > 0.0) || std::isinf(found) || !(wanted <= kLargestRms)) {
    throw std::invalid_argument(
        fmt::format("the heights have an r.m.s. value of {:.3g} m, expected up to {:g} m",
                    found > 0.0 && std::isfinite(found) ? wanted : found, kLargestRms));
  }
  const double begin = heights.front();
  for (double& height : heights) height = (height - begin) * (wanted / found);
  return heights;
}

}  // namespace sprung::dynamics

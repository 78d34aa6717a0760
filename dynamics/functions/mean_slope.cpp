#include "dynamics/functions/mean_slope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

constexpr double kSameSlope = 1e-12;  // relative

// An end of a piece: the density and the distribution function of the variable there, and the end in the
// piece's own variable.
struct End {
  double density = 0.0, below = 0.0, own = 0.0;
};

End make_end(double x, double mean, double origin, double sigma) {
  const double u = (x - mean) / sigma;
  return {.density = std::exp(-0.5 * u * u) / (sigma * std::sqrt(2.0 * std::numbers::pi)),
          .below = 0.5 * std::erfc(-u / std::numbers::sqrt2),
          .own = x - origin};
}

// ∫ P′ f over one piece P = Σ a_j s^j with the density f, by parts: with s₀ the mean of s,
// ∫ s^{j+1} f = s₀ ∫ s^j f + σ² (j ∫ s^{j−1} f − [s^j f]).
double integrate_slope(std::span<const double> a, double own_mean, const End& first, const End& last,
                       double sigma) {
  double before = 0.0, moment = last.below - first.below, sum = 0.0;  // ∫ s^{j−1} f, ∫ s^j f
  double power_first = first.density, power_last = last.density;      // s^j f at the ends
  for (std::size_t j = 0; j + 1 < a.size(); ++j) {
    const auto order = static_cast<double>(j);
    sum += (order + 1.0) * a[j + 1] * moment;
    const double next = own_mean * moment + sigma * sigma * (order * before - (power_last - power_first));
    before = moment;
    moment = next;
    power_first *= first.own;
    power_last *= last.own;
  }
  return sum;
}

}  // namespace

double calc_mean_slope(const PiecewisePolynomial& law, double sigma, double mean) {
  if (!(sigma > 0.0))
    throw std::invalid_argument(fmt::format("calc_mean_slope: sigma must be > 0, got {}", sigma));
  const std::span<const double> breaks = law.breaks();
  double sum = 0.0;
  for (std::size_t k = 0; k < law.num_pieces(); ++k) {
    const double origin = law.origin(k);
    const End first = k == 0 ? End{} : make_end(breaks[k - 1], mean, origin, sigma);
    const End last = k == breaks.size() ? End{.below = 1.0} : make_end(breaks[k], mean, origin, sigma);
    sum += integrate_slope(law.coefficients(k), mean - origin, first, last, sigma);
  }
  return sum;
}

bool has_one_slope(const PiecewisePolynomial& law) {
  const auto slope_of = [&](std::size_t k) {
    const std::span<const double> a = law.coefficients(k);
    return a.size() > 1 ? a[1] : 0.0;
  };
  const double slope = slope_of(0);
  for (std::size_t k = 0; k < law.num_pieces(); ++k) {
    const std::span<const double> a = law.coefficients(k);
    if (std::any_of(a.begin() + std::min<std::ptrdiff_t>(2, std::ssize(a)), a.end(),
                    [](double coefficient) { return coefficient != 0.0; }))
      return false;
    if (std::abs(slope_of(k) - slope) > kSameSlope * std::abs(slope)) return false;
  }
  return true;
}

}  // namespace sprung::dynamics

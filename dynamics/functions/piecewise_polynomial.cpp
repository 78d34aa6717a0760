#include "dynamics/functions/piecewise_polynomial.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "dynamics/functions/clamped_slopes.h"

namespace sprung::dynamics {

namespace {

// With more pieces than this, the search begins at the piece found last.
constexpr std::size_t kMany = 16;

// A dead band is a share of the shorter neighbour, so that a steep short piece is not continued far beyond
// its end, and not below a share of the largest dead band, since x may be rounded.
constexpr double kDeadBandShare = 1e-5, kLeastDeadBand = 1e-5;

double evaluate(std::span<const double> a, double s) {
  double sum = 0.0;
  for (std::size_t k = a.size(); k-- > 0;) sum = sum * s + a[k];
  return sum;
}

double evaluate_slope(std::span<const double> a, double s) {
  double sum = 0.0;
  for (std::size_t k = a.size(); k-- > 1;) sum = sum * s + static_cast<double>(k) * a[k];
  return sum;
}

double evaluate_curvature(std::span<const double> a, double s) {
  double sum = 0.0;
  for (std::size_t k = a.size(); k-- > 2;) {
    sum = sum * s + static_cast<double>(k - 1) * (static_cast<double>(k) * a[k]);
  }
  return sum;
}

// ∫₀ˢ of the piece in its own variable.
double evaluate_integral(std::span<const double> a, double s) {
  double sum = 0.0;
  for (std::size_t k = a.size(); k-- > 0;) sum = sum * s + a[k] / static_cast<double>(k + 1);
  return sum * s;
}

void check_points(const char* function, std::span<const double> x, std::span<const double> y) {
  if (x.size() < 2 || x.size() != y.size()) {
    throw std::invalid_argument(fmt::format("{}: needs at least 2 points and as many y as x, got {} and {}",
                                            function, x.size(), y.size()));
  }
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!(x[i] > x[i - 1])) {
      throw std::invalid_argument(
          fmt::format("{}: x must ascend, got {} after {}", function, x[i], x[i - 1]));
    }
  }
}

}  // namespace

PiecewisePolynomial::PiecewisePolynomial(std::vector<double> coefficients) {
  if (coefficients.empty()) coefficients.push_back(0.0);
  starts_ = {0};
  add_piece(0.0, coefficients);
  rebuild_integrals();
}

void PiecewisePolynomial::add_piece(double origin, std::span<const double> coefficients) {
  origins_.push_back(origin);
  coefficients_.insert(coefficients_.end(), coefficients.begin(), coefficients.end());
  starts_.push_back(coefficients_.size());
}

void PiecewisePolynomial::clear() {
  breaks_.clear();
  origins_.clear();
  coefficients_.clear();
  starts_ = {0};
}

PiecewisePolynomial PiecewisePolynomial::through_points(std::span<const double> x,
                                                        std::span<const double> y) {
  check_points("PiecewisePolynomial::through_points", x, y);
  PiecewisePolynomial f;
  f.clear();
  f.breaks_.assign(x.begin() + 1, x.end() - 1);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    f.add_piece(x[i], std::array{y[i], (y[i + 1] - y[i]) / (x[i + 1] - x[i])});
  }
  f.rebuild_integrals();
  return f;
}

PiecewisePolynomial PiecewisePolynomial::clamped_spline(std::span<const double> x,
                                                        std::span<const double> y) {
  const std::size_t n = x.size();
  const std::vector<double> m = calc_clamped_slopes(x, y);
  PiecewisePolynomial f;
  f.clear();
  f.breaks_.assign(x.begin() + 1, x.end() - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = x[i + 1] - x[i];
    const double secant = (y[i + 1] - y[i]) / h;
    f.add_piece(x[i], std::array{y[i], m[i], (3.0 * secant - 2.0 * m[i] - m[i + 1]) / h,
                                 (m[i] + m[i + 1] - 2.0 * secant) / (h * h)});
  }
  f.rebuild_integrals();
  return f;
}

PiecewisePolynomial PiecewisePolynomial::from_pieces(std::vector<double> breaks,
                                                     std::vector<std::vector<double>> pieces) {
  const bool has_empty =
      std::any_of(pieces.begin(), pieces.end(), [](const std::vector<double>& a) { return a.empty(); });
  if (breaks.empty() || pieces.size() != breaks.size() + 1 || has_empty) {
    throw std::invalid_argument(fmt::format(
        "PiecewisePolynomial::from_pieces: needs one more piece than breaks and none empty, got {} and {}",
        pieces.size(), breaks.size()));
  }
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    if (!(breaks[i] > breaks[i - 1])) {
      throw std::invalid_argument(fmt::format(
          "PiecewisePolynomial::from_pieces: breaks must ascend, got {} after {}", breaks[i], breaks[i - 1]));
    }
  }
  PiecewisePolynomial f;
  f.clear();
  f.breaks_ = std::move(breaks);
  for (std::size_t k = 0; k < pieces.size(); ++k) f.add_piece(f.breaks_[k > 0 ? k - 1 : 0], pieces[k]);
  f.rebuild_integrals();
  return f;
}

void PiecewisePolynomial::continue_straight(double at, double rate, bool below) {
  const PiecewisePolynomial old = *this;
  const std::size_t piece = find_piece(at);
  const std::array line{old.value(at), rate};
  clear();
  if (below) {
    breaks_ = {at};
    breaks_.insert(breaks_.end(), old.breaks_.begin() + static_cast<std::ptrdiff_t>(piece),
                   old.breaks_.end());
    add_piece(at, line);
    for (std::size_t k = piece; k < old.num_pieces(); ++k) add_piece(old.origin(k), old.coefficients(k));
  } else {
    for (std::size_t k = 0; k <= piece; ++k) add_piece(old.origin(k), old.coefficients(k));
    add_piece(at, line);
    breaks_.assign(old.breaks_.begin(), old.breaks_.begin() + static_cast<std::ptrdiff_t>(piece));
    breaks_.push_back(at);
  }
  rebuild_integrals();
}

double PiecewisePolynomial::value(double x) const {
  const std::size_t i = find_piece(x);
  return evaluate(coefficients(i), x - origins_[i]);
}

double PiecewisePolynomial::value_in_piece(int piece, double x) const {
  const auto i = static_cast<std::size_t>(piece);
  return evaluate(coefficients(i), x - origins_[i]);
}

double PiecewisePolynomial::calc_dead_band(std::size_t i, double largest) const {
  double band = largest;
  if (i > 0) band = std::min(band, kDeadBandShare * (breaks_[i] - breaks_[i - 1]));
  if (i + 1 < breaks_.size()) band = std::min(band, kDeadBandShare * (breaks_[i + 1] - breaks_[i]));
  return std::max(band, kLeastDeadBand * largest);
}

int PiecewisePolynomial::choose_piece(int piece, double x, double dead_band) const {
  const auto i = static_cast<std::size_t>(piece);
  const bool above_lower_end = i == 0 || x >= breaks_[i - 1] - 0.5 * calc_dead_band(i - 1, dead_band);
  const bool below_upper_end = i == breaks_.size() || x <= breaks_[i] + 0.5 * calc_dead_band(i, dead_band);
  return above_lower_end && below_upper_end ? piece : static_cast<int>(find_piece(x));
}

void PiecewisePolynomial::calc_piece_switches(int piece, double x, double dead_band,
                                              std::span<double> values) const {
  if (breaks_.empty()) return;
  const auto i = static_cast<std::size_t>(piece);
  values[0] = i == 0 ? 1.0 : x - breaks_[i - 1] + calc_dead_band(i - 1, dead_band);
  values[1] = i == breaks_.size() ? 1.0 : breaks_[i] - x + calc_dead_band(i, dead_band);
}

double PiecewisePolynomial::slope_in_piece(int piece, double x) const {
  const auto i = static_cast<std::size_t>(piece);
  return evaluate_slope(coefficients(i), x - origins_[i]);
}

double PiecewisePolynomial::slope(double x) const {
  const std::size_t i = find_piece(x);
  return evaluate_slope(coefficients(i), x - origins_[i]);
}

double PiecewisePolynomial::curvature(double x) const {
  const std::size_t i = find_piece(x);
  return evaluate_curvature(coefficients(i), x - origins_[i]);
}

double PiecewisePolynomial::integral(double x) const {
  const std::size_t i = find_piece(x);
  return integrals_[i] + evaluate_integral(coefficients(i), x - origins_[i]);
}

bool PiecewisePolynomial::is_zero() const {
  return std::all_of(coefficients_.begin(), coefficients_.end(),
                     [](double coefficient) { return coefficient == 0.0; });
}

bool PiecewisePolynomial::is_constant() const {
  for (std::size_t k = 0; k < num_pieces(); ++k) {
    const std::span<const double> a = coefficients(k);
    if (a.front() != coefficients_.front()) return false;
    if (std::any_of(a.begin() + 1, a.end(), [](double coefficient) { return coefficient != 0.0; }))
      return false;
  }
  return true;
}

std::size_t PiecewisePolynomial::find_piece(double x) const {
  const std::size_t last = last_piece_;
  if (breaks_.size() > kMany && last < breaks_.size() && x >= (last > 0 ? breaks_[last - 1] : x)) {
    if (x < breaks_[last]) return last;
    if (last + 1 < breaks_.size() && x < breaks_[last + 1]) {
      last_piece_ = last + 1;
      return last + 1;
    }
  }
  const auto i =
      static_cast<std::size_t>(std::upper_bound(breaks_.begin(), breaks_.end(), x) - breaks_.begin());
  if (breaks_.size() > kMany) last_piece_ = i;
  return i;
}

void PiecewisePolynomial::rebuild_integrals() {
  // At first from the origin of piece 0, then shifted so that they begin at 0.
  integrals_.assign(num_pieces(), 0.0);
  for (std::size_t i = 1; i < num_pieces(); ++i) {
    const double at_break =
        integrals_[i - 1] + evaluate_integral(coefficients(i - 1), breaks_[i - 1] - origins_[i - 1]);
    integrals_[i] = at_break - evaluate_integral(coefficients(i), breaks_[i - 1] - origins_[i]);
  }
  const double at_zero = integral(0.0);
  for (double& value : integrals_) value -= at_zero;
}

}  // namespace sprung::dynamics

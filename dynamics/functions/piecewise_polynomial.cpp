#include "dynamics/functions/piecewise_polynomial.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

double evaluate(const std::vector<double>& a, double s) {
  double sum = 0.0;
  for (std::size_t k = a.size(); k-- > 0;) sum = sum * s + a[k];
  return sum;
}

double evaluate_slope(const std::vector<double>& a, double s) {
  double sum = 0.0;
  for (std::size_t k = a.size(); k-- > 1;) sum = sum * s + static_cast<double>(k) * a[k];
  return sum;
}

// ∫₀ˢ of the piece in its own variable.
double evaluate_integral(const std::vector<double>& a, double s) {
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
  origins_ = {0.0};
  pieces_ = {std::move(coefficients)};
  rebuild_integrals();
}

PiecewisePolynomial PiecewisePolynomial::through_points(std::span<const double> x,
                                                        std::span<const double> y) {
  check_points("PiecewisePolynomial::through_points", x, y);
  PiecewisePolynomial f;
  f.breaks_.assign(x.begin() + 1, x.end() - 1);
  f.origins_.assign(x.begin(), x.end() - 1);
  f.pieces_.clear();
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    f.pieces_.push_back({y[i], (y[i + 1] - y[i]) / (x[i + 1] - x[i])});
  }
  f.rebuild_integrals();
  return f;
}

PiecewisePolynomial PiecewisePolynomial::clamped_spline(std::span<const double> x,
                                                        std::span<const double> y) {
  check_points("PiecewisePolynomial::clamped_spline", x, y);
  const std::size_t n = x.size();
  // Slopes m at the points from continuity of the second derivative, m₀ = m_{n−1} = 0: tridiagonal, by
  // elimination.
  std::vector<double> m(n, 0.0), diagonal(n, 1.0), upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = 1.0 / (x[i] - x[i - 1]);
    const double right = 1.0 / (x[i + 1] - x[i]);
    const double factor = left / diagonal[i - 1];
    diagonal[i] = 2.0 * (left + right) - factor * upper[i - 1];
    upper[i] = right;
    m[i] = 3.0 * ((y[i] - y[i - 1]) * left * left + (y[i + 1] - y[i]) * right * right) - factor * m[i - 1];
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] = (m[i] - upper[i] * m[i + 1]) / diagonal[i];

  PiecewisePolynomial f;
  f.breaks_.assign(x.begin() + 1, x.end() - 1);
  f.origins_.assign(x.begin(), x.end() - 1);
  f.pieces_.clear();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = x[i + 1] - x[i];
    const double secant = (y[i + 1] - y[i]) / h;
    f.pieces_.push_back(
        {y[i], m[i], (3.0 * secant - 2.0 * m[i] - m[i + 1]) / h, (m[i] + m[i + 1] - 2.0 * secant) / (h * h)});
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
  f.origins_ = breaks;
  f.origins_.insert(f.origins_.begin(), breaks.front());
  f.breaks_ = std::move(breaks);
  f.pieces_ = std::move(pieces);
  f.rebuild_integrals();
  return f;
}

void PiecewisePolynomial::continue_straight(double at, double rate, bool below) {
  const double value_at = value(at);
  const std::size_t piece = find_piece(at);
  const std::vector<double> line{value_at, rate};
  if (below) {
    breaks_.erase(breaks_.begin(), breaks_.begin() + static_cast<std::ptrdiff_t>(piece));
    origins_.erase(origins_.begin(), origins_.begin() + static_cast<std::ptrdiff_t>(piece));
    pieces_.erase(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(piece));
    breaks_.insert(breaks_.begin(), at);
    origins_.insert(origins_.begin(), at);
    pieces_.insert(pieces_.begin(), line);
  } else {
    breaks_.resize(piece);
    origins_.resize(piece + 1);
    pieces_.resize(piece + 1);
    breaks_.push_back(at);
    origins_.push_back(at);
    pieces_.push_back(line);
  }
  rebuild_integrals();
}

void PiecewisePolynomial::cut_off_below(double at) {
  const double value_at = value(at);
  if (value_at != 0.0) {
    throw std::invalid_argument(
        fmt::format("PiecewisePolynomial::cut_off_below: must be 0 at {}, got {}", at, value_at));
  }
  continue_straight(at, 0.0, true);
}

double PiecewisePolynomial::value(double x) const {
  const std::size_t i = find_piece(x);
  return evaluate(pieces_[i], x - origins_[i]);
}

double PiecewisePolynomial::value_in_piece(int piece, double x) const {
  const auto i = static_cast<std::size_t>(piece);
  return evaluate(pieces_[i], x - origins_[i]);
}

int PiecewisePolynomial::choose_piece(int piece, double x, double dead_band) const {
  const auto i = static_cast<std::size_t>(piece);
  const bool above_lower_end = i == 0 || x >= breaks_[i - 1] - 0.5 * dead_band;
  const bool below_upper_end = i == breaks_.size() || x <= breaks_[i] + 0.5 * dead_band;
  return above_lower_end && below_upper_end ? piece : static_cast<int>(find_piece(x));
}

void PiecewisePolynomial::calc_piece_switches(int piece, double x, double dead_band,
                                              std::span<double> values) const {
  if (breaks_.empty()) return;
  const auto i = static_cast<std::size_t>(piece);
  values[0] = i == 0 ? 1.0 : x - breaks_[i - 1] + dead_band;
  values[1] = i == breaks_.size() ? 1.0 : breaks_[i] - x + dead_band;
}

double PiecewisePolynomial::slope(double x) const {
  const std::size_t i = find_piece(x);
  return evaluate_slope(pieces_[i], x - origins_[i]);
}

double PiecewisePolynomial::integral(double x) const {
  const std::size_t i = find_piece(x);
  return integrals_[i] + evaluate_integral(pieces_[i], x - origins_[i]);
}

PiecewisePolynomial PiecewisePolynomial::derivative() const {
  PiecewisePolynomial f = *this;
  for (std::vector<double>& a : f.pieces_) {
    for (std::size_t k = 1; k < a.size(); ++k) a[k - 1] = static_cast<double>(k) * a[k];
    if (a.size() > 1)
      a.pop_back();
    else
      a[0] = 0.0;
  }
  f.rebuild_integrals();
  return f;
}

bool PiecewisePolynomial::is_zero() const {
  const auto vanishes = [](const std::vector<double>& a) {
    return std::all_of(a.begin(), a.end(), [](double coefficient) { return coefficient == 0.0; });
  };
  return std::all_of(pieces_.begin(), pieces_.end(), vanishes);
}

bool PiecewisePolynomial::is_constant() const {
  return std::all_of(pieces_.begin(), pieces_.end(), [&](const std::vector<double>& a) {
    return a.front() == pieces_.front().front() &&
           std::all_of(a.begin() + 1, a.end(), [](double coefficient) { return coefficient == 0.0; });
  });
}

std::size_t PiecewisePolynomial::find_piece(double x) const {
  return static_cast<std::size_t>(std::upper_bound(breaks_.begin(), breaks_.end(), x) - breaks_.begin());
}

void PiecewisePolynomial::rebuild_integrals() {
  // At first from the origin of piece 0, then shifted so that they begin at 0.
  integrals_.assign(pieces_.size(), 0.0);
  for (std::size_t i = 1; i < pieces_.size(); ++i) {
    const double at_break =
        integrals_[i - 1] + evaluate_integral(pieces_[i - 1], breaks_[i - 1] - origins_[i - 1]);
    integrals_[i] = at_break - evaluate_integral(pieces_[i], breaks_[i - 1] - origins_[i]);
  }
  const double at_zero = integral(0.0);
  for (double& value : integrals_) value -= at_zero;
}

}  // namespace sprung::dynamics

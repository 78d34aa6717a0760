#include "dynamics/functions/piecewise_arithmetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sprung::dynamics {

namespace {

using Coefficients = std::vector<double>;

// Σ a_k (x − from)^k as a polynomial in (x − to), by repeated synthetic division.
Coefficients move_origin(std::span<const double> a, double from, double to) {
  Coefficients moved(a.begin(), a.end());
  if (from == to) return moved;
  for (std::size_t first = 0; first + 1 < moved.size(); ++first) {
    for (std::size_t k = moved.size() - 1; k-- > first;) moved[k] += (to - from) * moved[k + 1];
  }
  return moved;
}

// The polynomial of f that holds from `start` on, or before it, in (x − origin).
Coefficients take_piece(const PiecewisePolynomial& f, double start, bool before, double origin) {
  const std::span<const double> breaks = f.breaks();
  const auto next = before ? std::lower_bound(breaks.begin(), breaks.end(), start)
                           : std::upper_bound(breaks.begin(), breaks.end(), start);
  const auto piece = static_cast<std::size_t>(next - breaks.begin());
  return move_origin(f.coefficients(piece), f.origin(piece), origin);
}

std::vector<double> merge_breaks(std::span<const double> a, std::span<const double> b) {
  std::vector<double> merged;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(merged));
  return merged;
}

// Combines the polynomials of a and b piece by piece.
template <class Operation>
PiecewisePolynomial combine(const PiecewisePolynomial& a, const PiecewisePolynomial& b,
                            const Operation& operation) {
  std::vector<double> breaks = merge_breaks(a.breaks(), b.breaks());
  if (breaks.empty()) {
    return PiecewisePolynomial(operation(take_piece(a, 0.0, false, 0.0), take_piece(b, 0.0, false, 0.0)));
  }
  std::vector<Coefficients> pieces;
  const auto add = [&](double start, bool before) {
    pieces.push_back(operation(take_piece(a, start, before, start), take_piece(b, start, before, start)));
  };
  add(breaks.front(), true);
  for (const double start : breaks) add(start, false);
  return PiecewisePolynomial::from_pieces(std::move(breaks), std::move(pieces));
}

}  // namespace

PiecewisePolynomial calc_sum(const PiecewisePolynomial& a, const PiecewisePolynomial& b) {
  return combine(a, b, [](Coefficients x, const Coefficients& y) {
    x.resize(std::max(x.size(), y.size()), 0.0);
    for (std::size_t k = 0; k < y.size(); ++k) x[k] += y[k];
    return x;
  });
}

PiecewisePolynomial calc_product(const PiecewisePolynomial& a, const PiecewisePolynomial& b) {
  return combine(a, b, [](const Coefficients& x, const Coefficients& y) {
    Coefficients product(x.size() + y.size() - 1, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t k = 0; k < y.size(); ++k) product[i + k] += x[i] * y[k];
    }
    return product;
  });
}

PiecewisePolynomial join_parts(std::span<const double> ends, std::span<const PiecewisePolynomial> parts) {
  if (ends.empty() || parts.size() != ends.size() + 1) {
    throw std::invalid_argument(
        fmt::format("join_parts: needs one more part than ends, got {} and {}", parts.size(), ends.size()));
  }
  std::vector<double> breaks;
  std::vector<Coefficients> pieces{};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    // The first piece of a part begins at its end, from where the part before it came.
    const bool is_first = k == 0, is_last = k == ends.size();
    std::vector<double> starts;
    if (!is_first) starts.push_back(ends[k - 1]);
    for (const double at : parts[k].breaks()) {
      if ((is_first || at > ends[k - 1]) && (is_last || at < ends[k])) starts.push_back(at);
    }
    if (is_first) {
      const double origin = starts.empty() ? ends[0] : starts.front();
      pieces.push_back(take_piece(parts[0], origin, true, origin));
    }
    for (const double start : starts) {
      breaks.push_back(start);
      pieces.push_back(take_piece(parts[k], start, false, start));
    }
  }
  return PiecewisePolynomial::from_pieces(std::move(breaks), std::move(pieces));
}

}  // namespace sprung::dynamics

#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sprung::dynamics {

/// A function of one variable made of polynomials end to end: characteristics of springs, dampers and tyres,
/// tables, splines. Continuous. The first and the last piece go on for ever.
class PiecewisePolynomial {
 public:
  PiecewisePolynomial() : PiecewisePolynomial(std::vector<double>{0.0}) {}

  /// One polynomial Σ a_k x^k.
  explicit PiecewisePolynomial(std::vector<double> coefficients);

  /// Straight lines through points; ends go on with the slope of their last piece.
  /// @param x ascending, at least 2; y as many
  /// @throws std::invalid_argument
  static PiecewisePolynomial through_points(std::span<const double> x, std::span<const double> y);

  /// Cubic spline through points, twice continuously differentiable, with zero slope at both ends.
  /// Source: [de Boor 2001], ch. IV, complete spline interpolation
  /// @param x ascending, at least 2; y as many
  static PiecewisePolynomial clamped_spline(std::span<const double> x, std::span<const double> y);

  /// Polynomials end to end: pieces[0] up to breaks[0], pieces[k] from breaks[k − 1] on, as coefficients of
  /// (x − breaks[k − 1])^j; the first of (x − breaks[0])^j.
  /// @param breaks ascending, at least 1; one more piece than breaks, none empty
  /// @throws std::invalid_argument
  static PiecewisePolynomial from_pieces(std::vector<double> breaks, std::vector<std::vector<double>> pieces);

  /// From `at` on (or up to `at`, for below = true) the function continues straight with slope `rate`.
  void continue_straight(double at, double rate, bool below);
  /// Below `at` the function is zero (its value at `at` has to be zero).
  void cut_off_below(double at);

  double value(double x) const;
  double slope(double x) const;            ///< from the right at a break
  double integral(double x) const;         ///< ∫₀ˣ
  PiecewisePolynomial derivative() const;  ///< may jump at the breaks

  bool is_zero() const;  ///< everywhere

  std::span<const double> breaks() const { return breaks_; }  ///< between pieces, ascending

  std::size_t num_pieces() const { return pieces_.size(); }
  /// Of piece k: Σ coefficients_j (x − origin)^j.
  double origin(std::size_t k) const { return origins_[k]; }
  std::span<const double> coefficients(std::size_t k) const { return pieces_[k]; }

  /// A piece's polynomial, at x that may lie beyond its ends.
  double value_in_piece(int piece, double x) const;
  /// The 0-based piece to use at x, where `piece` has been in use: that one until x is half a dead band
  /// beyond its ends, so that x trembling at a break does not change pieces again and again.
  int choose_piece(int piece, double x, double dead_band) const;
  /// Two, the ends of the piece in use; none where one piece is all there is.
  int num_switches() const { return breaks_.empty() ? 0 : 2; }
  /// @param[out] values  num_switches: positive while x has not gone a dead band beyond the lower, the upper
  /// end of the piece
  void calc_piece_switches(int piece, double x, double dead_band, std::span<double> values) const;

 private:
  std::size_t find_piece(double x) const;
  void rebuild_integrals();

  std::vector<double> breaks_;               // P − 1 of them
  std::vector<double> origins_;              // P: each piece is a polynomial in (x − origin)
  std::vector<std::vector<double>> pieces_;  // P coefficient lists
  std::vector<double> integrals_;            // P: ∫ from 0 to the origin of the piece
};

}  // namespace sprung::dynamics

#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sprung::dynamics {

/// A function of one variable, made of polynomials joined end to end: characteristics of springs, dampers and
/// tyres, tables, splines. The first and the last piece continue for ever. A function made by `from_pieces`
/// may jump at a break, where it has the value of the piece that begins.
class PiecewisePolynomial {
 public:
  PiecewisePolynomial() : PiecewisePolynomial(std::vector<double>{0.0}) {}

  /// One polynomial Σ a_k x^k.
  explicit PiecewisePolynomial(std::vector<double> coefficients);

  /// Straight lines through points; beyond the ends, the outermost lines continue.
  /// @param x ascending, at least 2; y as many
  /// @throws std::invalid_argument
  static PiecewisePolynomial through_points(std::span<const double> x, std::span<const double> y);

  /// Cubic spline through points, twice continuously differentiable, with zero slope at both ends.
  /// Source: [de Boor 2001], ch. IV, complete spline interpolation
  /// @param x ascending, at least 2; y as many
  static PiecewisePolynomial clamped_spline(std::span<const double> x, std::span<const double> y);

  /// Polynomials joined end to end. pieces[0] ends at breaks[0] and pieces[k] begins at breaks[k − 1]. Entry
  /// j of pieces[k] is the coefficient of (x − breaks[k − 1])^j, in pieces[0] of (x − breaks[0])^j.
  /// @param breaks ascending, at least 1   @param pieces  one more than breaks, none empty
  /// @throws std::invalid_argument
  static PiecewisePolynomial from_pieces(std::vector<double> breaks, std::vector<std::vector<double>> pieces);

  /// Replaces the function beyond `at` (below = true: before `at`) by a straight line with slope `rate`.
  void continue_straight(double at, double rate, bool below);

  double value(double x) const;
  double slope(double x) const;      ///< from the right at a break
  double curvature(double x) const;  ///< second derivative, from the right at a break
  double integral(double x) const;   ///< ∫₀ˣ

  bool is_zero() const;      ///< it is zero everywhere
  bool is_constant() const;  ///< it has one value everywhere

  std::span<const double> breaks() const { return breaks_; }  ///< between pieces, ascending

  std::size_t num_pieces() const { return origins_.size(); }
  /// Piece k is Σ coefficients(k)[j] (x − origin(k))^j.
  double origin(std::size_t k) const { return origins_[k]; }
  std::span<const double> coefficients(std::size_t k) const {
    return {coefficients_.data() + starts_[k], starts_[k + 1] - starts_[k]};
  }

  /// The polynomial of one piece, and its slope; x may lie beyond its ends.
  double value_in_piece(int piece, double x) const;
  double slope_in_piece(int piece, double x) const;
  /// The piece to use at x, from 0. It is the piece in use until x is half a dead band beyond its ends, so
  /// that small changes of x at a break do not change the piece each time. @param piece  in use
  /// @param dead_band  the largest; at a break next to a short piece it is 1e-5 of this piece
  int choose_piece(int piece, double x, double dead_band) const;
  /// 2, for the two ends of the piece in use; 0 for a function of one piece.
  int num_switches() const { return breaks_.empty() ? 0 : 2; }
  /// @param[out] values  num_switches: positive until x is a dead band beyond the lower end of the piece, and
  /// the upper one
  void calc_piece_switches(int piece, double x, double dead_band, std::span<double> values) const;

 private:
  std::size_t find_piece(double x) const;
  double calc_dead_band(std::size_t i, double largest) const;  // at break i
  void add_piece(double origin, std::span<const double> coefficients);
  void clear();  // leaves no piece
  void rebuild_integrals();

  std::vector<double> breaks_;        // P − 1 of them
  std::vector<double> origins_;       // P: each piece is a polynomial in (x − origin)
  std::vector<double> coefficients_;  // of all pieces, one after the other
  std::vector<std::size_t> starts_;   // P + 1: where those of each piece start, and where the last ones end
  std::vector<double> integrals_;     // P: ∫ from 0 to the origin of the piece
  // The piece found last, where the next search begins. Results do not depend on it; threads may not share
  // it.
  mutable std::size_t last_piece_ = 0;
};

}  // namespace sprung::dynamics

#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace sprung::dynamics {

/// One-sided spectral density G of the height of a random road over the wavenumber n, in waves per metre. ∫ G
/// dn is the mean square of the height.
///
/// It is a power law G = G(n₀) (n/n₀)^−w with n₀ = 0.1 1/m (road, eq. 1), or straight lines between points in
/// the logarithms of n and G. Outside of a band it is zero.
///
/// Source: [ISO 8608], annexes A and C
class RoadSpectrum {
 public:
  static constexpr double kReferenceWavenumber = 0.1;  ///< n₀ [1/m]

  /// A power law. @param reference_density  G(n₀) > 0 [m³] @param exponent  w
  /// @throws std::invalid_argument
  static RoadSpectrum power_law(double reference_density, double exponent);
  /// @param wavenumber  ascending, > 0, at least 2 [1/m] @param density  as many, > 0 [m³]
  /// @throws std::invalid_argument
  static RoadSpectrum through_points(std::span<const double> wavenumber, std::span<const double> density);

  /// Makes the density zero outside of lowest to highest [1/m].
  /// @throws std::invalid_argument unless 0 ≤ lowest < highest
  void limit_to(double lowest, double highest);

  double density(double wavenumber) const;  ///< at n > 0 [m³]
  /// Wavenumbers at which the density has a kink or a jump, or ends; ascending [1/m].
  std::vector<double> breaks() const;

 private:
  RoadSpectrum() = default;
  std::vector<double> log_wavenumber_, log_density_;  // of points; a power law has two
  double lowest_ = 0.0, highest_;
};

/// G(n₀) of an ISO 8608 class, 'A' to 'H': the geometric mean of the class, 16·4^k·10⁻⁶ m³, k = 0 … 7.
/// @throws std::invalid_argument for another letter
double calc_iso_density(char road_class);

}  // namespace sprung::dynamics

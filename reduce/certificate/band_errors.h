#pragma once

#include <Eigen/Core>
#include <vector>

#include "reduce/certificate/interface_residual.h"

namespace sprung::reduce {

/// A part of the band with amplitudes that are the same all over it.
struct BandPart {
  double begin = 0.0, end = 0.0;  ///< ω² [rad²/s²]
};

/// Upper bounds of what a basis misses of the interface flexibility, over a whole band.
struct BandErrors {
  Eigen::VectorXd error;                ///< b, of each load's own freedom [m/N, rad/(N·m)]
  Eigen::VectorXd worst_omega_squared;  ///< b, where the bound is the largest
  std::vector<BandPart> worst_part;     ///< b, on which the bound is the largest
  std::vector<BandPart> parts;          ///< that the bounds were made on
};

/// Bounds the error at every frequency of a band, not only at those that are looked at. With the amplitudes
/// of the middle of a part, D is a convex quadratic in s all over it, and its largest value is at an end
/// (reduce/certificate, eq. 6). Parts are halved until the bound is within 2 % of a value that it takes, or
/// of what is negligible.
///
/// @param highest  ω² at the end of the band; cutoff  λ_c > highest, below which the residual has no mode
///                 [rad²/s²]   @param negligible  share of the static flexibility
/// @throws std::invalid_argument if cutoff ≤ highest
/// Checked by tests/reduce/certificate/certify_test.cpp
BandErrors calc_band_errors(const InterfaceResidual& residual, double highest, double cutoff,
                            double negligible = 1e-10);

}  // namespace sprung::reduce

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "reduce/certificate/certify.h"
#include "reduce/modes/modes_below.h"
#include "reduce/superelement/certificate.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

/// What a residual vector is made from: K⁻¹r of a load at a frequency.
struct ResidualSource {
  Eigen::Index load = 0;
  double omega_squared = 0.0;  ///< [rad²/s²]
};

/// Vectors that a body's elastic motion is reduced to, in ascending ω². They are those of the held frame, n
/// values each, and normalised for the elastic motion of the free body (reduce/basis, eq. 3).
struct FreeBodyBasis {
  EigenPairs vectors;             ///< m
  std::vector<std::string> kind;  ///< m (superelement/certificate.h)
  Certificate certificate;
  std::vector<ResidualSource> residuals;  ///< of a free basis, in the order in which they joined
};

/// What a basis has to serve.
struct BasisRequest {
  std::vector<InterfaceFreedom> interface;
  Eigen::MatrixXd loads;  ///< of the interface: unit loads, balanced, n×b
  /// Loads of the soft twin by motion of the body frame, balanced: unit loads at the reference node's three
  /// freedoms, and ∫(x N_x + y N_y) dm (fem/mass_moments.h), n×4
  Eigen::MatrixXd frame_loads;
  double highest_hz = 0.0;             ///< the end of the band
  double tolerance = 0.01;             ///< share of the static flexibility that may be missing
  bool all_residual = false;           ///< the static response to every load, whatever the tolerance
  double rounding = 0.0;               ///< largest relative rounding error of an ω² (rounding_error.h)
  Progress progress = {};              ///< may be empty
  support::SourceLocation where = {};  ///< for messages
};

/// The free modes that a band needs are those below this multiple of its end.
inline constexpr double kBandMargin = 1.5;

}  // namespace sprung::reduce

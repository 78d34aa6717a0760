#pragma once

#include <vector>

#include "reduce/certificate/interface_loads.h"
#include "reduce/certificate/interface_residual.h"
#include "reduce/superelement/certificate.h"

namespace sprung::reduce {

/// Below this share of the static flexibility all is rounding, where the stiffness itself is not worse.
inline constexpr double kRoundingFloor = 1e-8;

/// What a certificate is made from, beside the residual.
struct CertificateRequest {
  std::vector<InterfaceFreedom> interface;
  Eigen::MatrixXd frame_loads;  ///< n×4, see BasisRequest
  double highest_hz = 0.0;
  double tolerance = 0.0;           ///< that was asked for, or 0
  EigenPairs free_modes;            ///< all below 1.5 highest_hz
  double next_omega_squared = 0.0;  ///< of the free mode after those; infinite where there is none
  bool holds_free_modes = false;    ///< whether the residual's exact modes are these
  bool is_complete = false;         ///< whether the basis holds every motion of the model
  double rounding = 0.0;            ///< largest relative rounding error of an ω² (rounding_error.h)
};

/// λ_c of a request: ω² of the lowest free mode that the basis does not hold exactly; infinite where it holds
/// all.
double calc_cutoff(const CertificateRequest& request);

/// Bounds what a basis misses over the band, for each interface freedom (reduce/certificate, eqs. 5, 6, 8,
/// 9). Where a free mode that the basis does not hold exactly lies in the band, there is no bound: near that
/// mode the error grows without limit.
/// @param residual  of the interface; the frame's loads are added to it for the soft twin
/// Checked by tests/reduce/certificate/certify_test.cpp
Certificate calc_certificate(InterfaceResidual& residual, const CertificateRequest& request);

}  // namespace sprung::reduce

#include "reduce/certificate/certify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reduce/certificate/band_errors.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr Eigen::Index kMostSoftLoads = 200;  // b above which no soft twin is made: it takes b×b matrices
constexpr double kNoDirection = 1e-14;        // of D̄ with scaled loads, below which a direction is rounding

// A load that deforms nothing has no share.
double calc_share(double error, double flexibility) {
  return flexibility > 0.0 ? error / flexibility : 0.0;
}

// λ and x of a symmetric matrix.
support::SymmetricEigenpairs solve(const Eigen::MatrixXd& matrix) {
  const auto pairs = support::solve_symmetric(matrix);
  if (!pairs) throw support::NumericalError("certificate: the error of the interface has no eigenvalues");
  return *pairs;
}

// The part of a symmetric matrix with positive eigenvalues.
Eigen::MatrixXd calc_positive_part(const Eigen::MatrixXd& matrix) {
  const support::SymmetricEigenpairs pairs = solve(matrix);
  return pairs.vectors * pairs.values.cwiseMax(0.0).asDiagonal() * pairs.vectors.transpose();
}

// A matrix that is nowhere in the band below D of the scaled loads, in the sense of quadratic forms: with the
// amplitudes of a part's middle, D is convex in s, so that it is enough to be above it at both ends.
Eigen::MatrixXd calc_upper_error(const InterfaceResidual& residual, const std::vector<BandPart>& parts,
                                 const Eigen::VectorXd& scale) {
  Eigen::MatrixXd upper = Eigen::MatrixXd::Zero(residual.num_loads(), residual.num_loads());
  const Eigen::MatrixXd load_work = residual.calc_load_work();
  for (const BandPart& part : parts) {
    const Eigen::MatrixXd y = residual.calc_amplitudes(0.5 * (part.begin + part.end));
    for (const double s : {part.begin, part.end}) {
      const Eigen::MatrixXd error = residual.calc_error_matrix(load_work, s, y);
      upper += calc_positive_part(scale.asDiagonal() * error * scale.asDiagonal() - upper);
    }
  }
  return upper;
}

// Modes of the soft twin: F, q×loads, and their shares at rest.
struct SoftModes {
  Eigen::MatrixXd loads;
  Eigen::VectorXd static_share;
};

// F of Fᵀ F = λ_c D̄ with unit loads scaled to equal flexibility, without what is rounding; turned so that the
// error at rest is Fᵀ w F/λ_c with a diagonal w.                             (reduce/certificate, eqs. 8, 9)
SoftModes calc_soft_modes(const InterfaceResidual& residual, const std::vector<BandPart>& parts,
                          double cutoff) {
  const double tiny = std::numeric_limits<double>::min();
  const Eigen::VectorXd scale = residual.static_flexibility().cwiseMax(tiny).cwiseSqrt();
  const Eigen::VectorXd by_scale = scale.cwiseInverse();
  const support::SymmetricEigenpairs upper = solve(calc_upper_error(residual, parts, by_scale));
  const Eigen::Index q = (upper.values.array() > kNoDirection).count();
  const Eigen::VectorXd sizes = upper.values.tail(q).cwiseSqrt();
  const Eigen::MatrixXd at_rest =
      residual.calc_error_matrix(residual.calc_load_work(), 0.0, residual.calc_amplitudes(0.0));
  const Eigen::MatrixXd directions =
      by_scale.asDiagonal() * upper.vectors.rightCols(q) * sizes.cwiseInverse().asDiagonal();
  const support::SymmetricEigenpairs shares = solve(directions.transpose() * at_rest * directions);
  const Eigen::MatrixXd loads = scale.asDiagonal() * upper.vectors.rightCols(q) * sizes.asDiagonal();
  return {.loads = std::sqrt(cutoff) * (loads * shares.vectors).transpose(),
          .static_share = shares.values.cwiseMax(0.0).cwiseMin(1.0)};
}

// Relative errors of the free frequencies in the basis.
Eigen::VectorXd calc_frequency_errors(const InterfaceResidual& residual, const CertificateRequest& request) {
  const Eigen::Index k = request.free_modes.omega_squared.size();
  if (request.holds_free_modes || request.is_complete) return Eigen::VectorXd::Zero(k);
  const Eigen::VectorXd found = residual.ritz().omega_squared;
  Eigen::VectorXd errors = Eigen::VectorXd::Constant(k, kUnbounded);
  for (Eigen::Index i = 0; i < std::min(k, found.size()); ++i) {
    errors(i) = std::abs(std::sqrt(found(i) / request.free_modes.omega_squared(i)) - 1.0);
  }
  return errors;
}

}  // namespace

double calc_cutoff(const CertificateRequest& request) {
  if (request.is_complete) return std::numeric_limits<double>::infinity();
  if (request.holds_free_modes || request.free_modes.omega_squared.size() == 0) {
    return request.next_omega_squared;
  }
  return request.free_modes.omega_squared(0);
}

Certificate calc_certificate(InterfaceResidual& residual, const CertificateRequest& request) {
  const double cutoff = calc_cutoff(request), highest = std::pow(kTwoPi * request.highest_hz, 2);
  Certificate certificate;
  certificate.highest_hz = request.highest_hz;
  certificate.tolerance = request.tolerance;
  certificate.cutoff_hz = std::isinf(cutoff) ? 0.0 : calc_frequency_hz(cutoff);
  certificate.rounding_floor = std::max(kRoundingFloor, request.rounding);
  certificate.free_hz = request.free_modes.omega_squared.cwiseSqrt() / kTwoPi;
  certificate.free_error = calc_frequency_errors(residual, request);
  const Eigen::Index b = residual.num_loads();
  const Eigen::VectorXd flexibility = residual.static_flexibility();
  Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(b);
  const bool bounded = cutoff > highest, misses = !std::isinf(cutoff);
  BandErrors band{.error = at_rest, .worst_omega_squared = at_rest, .worst_part = {}, .parts = {}};
  if (misses) at_rest = residual.calc_errors(0.0, residual.calc_amplitudes(0.0));
  if (bounded && misses) band = calc_band_errors(residual, highest, cutoff, certificate.rounding_floor);
  SoftModes soft{.loads = Eigen::MatrixXd(0, b + 4), .static_share = {}};
  if (bounded && misses && b <= kMostSoftLoads) {
    residual.add_loads(request.frame_loads);
    soft = calc_soft_modes(residual, band.parts, cutoff);
  }
  certificate.soft_loads = soft.loads.leftCols(b);
  certificate.soft_reference = soft.loads.middleCols(b, 3);
  certificate.soft_radial = soft.loads.col(b + 3);
  certificate.soft_static_share = soft.static_share;
  for (Eigen::Index j = 0; j < b; ++j) {
    const InterfaceFreedom& freedom = request.interface[static_cast<std::size_t>(j)];
    certificate.interface.push_back(
        {.point = freedom.point,
         .freedom = freedom.freedom,
         .static_flexibility = flexibility(j),
         .static_error = calc_share(at_rest(j), flexibility(j)),
         .error = bounded ? calc_share(band.error(j), flexibility(j)) : kUnbounded,
         .worst_hz = bounded ? calc_frequency_hz(band.worst_omega_squared(j)) : 0.0});
  }
  return certificate;
}

}  // namespace sprung::reduce

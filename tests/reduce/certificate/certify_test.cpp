#include "reduce/certificate/certify.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reduce/certificate/band_errors.h"
#include "reduce/reduction/inertia_invariants.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/certificate/certified_frame.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using testing::CertifiedFrame;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// A file's certificate against the flexibility of the full model, which is solved directly, less that of the
// file's values, over the whole band.
void check_certificate(std::uint64_t seed, int num_frequencies) {
  const Design design = testing::make_random_design(seed, seed % 2 == 0 ? 0.01 : 0.1);
  const Superelement body = make_superelement(design);
  const Certificate& certificate = *body.certificate;
  const testing::FreeBodyTruth truth(design.model);
  const auto b = static_cast<Eigen::Index>(certificate.interface.size());
  Eigen::VectorXd bound(b), flexibility(b), largest = Eigen::VectorXd::Zero(b);
  for (Eigen::Index j = 0; j < b; ++j) {
    const InterfaceError& one = certificate.interface[static_cast<std::size_t>(j)];
    flexibility(j) = one.static_flexibility;
    bound(j) = one.error * one.static_flexibility;
  }
  for (int step = 1; step <= num_frequencies; ++step) {
    const double s = std::pow(kTwoPi * certificate.highest_hz * step / num_frequencies, 2);
    if (testing::is_resonance(truth, s)) continue;  // both flexibilities are infinite
    const Eigen::VectorXd error = truth.calc_flexibility(s, design.reduction.interface).real().diagonal() -
                                  testing::calc_flexibility(body, s).diagonal();
    // Near a resonance of the body the flexibility is large, and so is its rounding.
    const Eigen::VectorXd rounding =
        1e-8 * flexibility + 1e-9 * testing::calc_flexibility(body, s).diagonal().cwiseAbs();
    INFO("seed " << seed << ", step " << step);
    CHECK((bound - error + rounding).minCoeff() >= 0.0);
    CHECK((error + rounding).minCoeff() >= 0.0);
    largest = largest.cwiseMax(error);
  }
  CHECK(certificate.largest_error() <= certificate.tolerance);
  if (certificate.cutoff_hz < 1.7 * certificate.highest_hz) return;
  const auto worst = static_cast<Eigen::Index>(certificate.find_worst());
  CHECK(bound(worst) <= 1.6 * largest(worst) + 1e-7 * flexibility(worst));
}

TEST_CASE(
    "over the band the certificate is above the true error of 200 random frames, by less than 1.6 where λ_c "
    "is "
    "far") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) check_certificate(seed, 60);
}

TEST_CASE(
    "the bound over a band is above the true error at every frequency in it, and nearly the bound at one of "
    "them") {
  for (const std::uint64_t seed : {1, 3, 10}) {
    const CertifiedFrame frame(seed, 4);
    const BandErrors band = calc_band_errors(*frame.residual, frame.highest, frame.cutoff);
    // D of Galerkin's amplitudes is below the true error (reduce/certificate, eq. 5).
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(frame.loads.cols()), least = largest;
    for (int step = 0; step <= 500; ++step) {
      const double s = frame.highest * step / 500.0;
      const Eigen::VectorXd D = frame.residual->calc_errors(s, frame.residual->calc_amplitudes(s));
      least = least.cwiseMax(D);
      largest = largest.cwiseMax(D / (1.0 - s / frame.cutoff));
    }
    CHECK((band.error - least).minCoeff() >= 0.0);
    const Eigen::VectorXd negligible = 1e-9 * frame.residual->static_flexibility();
    CHECK((1.03 * largest + negligible - band.error).minCoeff() >= 0.0);
  }
  const CertifiedFrame frame(1, 0);
  CHECK_THROWS_AS(calc_band_errors(*frame.residual, frame.cutoff, frame.cutoff), std::invalid_argument);
}

Eigen::VectorXd list_errors(const Certificate& certificate) {
  Eigen::VectorXd errors(static_cast<Eigen::Index>(certificate.interface.size()));
  for (std::size_t j = 0; j < certificate.interface.size(); ++j)
    errors(static_cast<Eigen::Index>(j)) = certificate.interface[j].error;
  return errors;
}

// The certificate of a basis that lacks one of its vectors: larger at some freedom, and smaller at none, but
// for the 3 % by which the pass over the band may be above the bound.
TEST_CASE("a basis without one of its vectors has a larger certificate") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const CertifiedFrame whole(seed, 5);
    const Eigen::VectorXd certified = list_errors(calc_certificate(*whole.residual, whole.make_request()));
    const EigenPairs vectors = whole.residual->ritz();
    for (Eigen::Index left_out = 0; left_out < vectors.vectors.cols(); ++left_out) {
      InterfaceResidual residual(whole.matrices.free, *whole.factor, whole.modes.pairs, whole.loads);
      for (Eigen::Index i = 0; i < vectors.vectors.cols(); ++i) {
        if (i != left_out) residual.add(vectors.vectors.col(i));
      }
      const Eigen::VectorXd errors = list_errors(calc_certificate(residual, whole.make_request()));
      INFO("seed " << seed << ", vector " << left_out << ": " << errors.transpose() << " after "
                   << certified.transpose());
      CHECK((1.03 * errors - certified).minCoeff() >= 0.0);
      CHECK((errors - certified).maxCoeff() > 1e-3 * certified.maxCoeff());
    }
  }
}

TEST_CASE(
    "a basis that holds a free mode of the band at another frequency has no bound, and says how far off") {
  Design design = testing::make_random_design(4, 0.01);
  design.reduction.basis = BasisKind::kClamped;
  design.modes = {.wanted = ModeCount{8}};
  const Eigen::VectorXd expected = testing::FreeBodyTruth(design.model).calc_frequencies();
  design.reduction.highest_hz = 0.5 * (expected(1) + expected(2));
  const Certificate certificate = *make_superelement(design).certificate;
  CHECK_FALSE(certificate.is_bounded());
  CHECK(certificate.soft_loads.rows() == 0);
  REQUIRE(certificate.free_hz.size() >= 2);
  CHECK((certificate.free_hz.cwiseQuotient(expected.head(certificate.free_hz.size())).array() - 1.0)
            .abs()
            .maxCoeff() < 1e-9);
  CHECK(certificate.free_error(0) > 1e-6);
  // At rest the error is exact for every basis.
  const Superelement body = make_superelement(design);
  const Eigen::VectorXd missing =
      testing::FreeBodyTruth(design.model).calc_flexibility_at_rest(design.reduction.interface).diagonal() -
      testing::calc_flexibility(body, 0.0).diagonal();
  for (std::size_t j = 0; j < certificate.interface.size(); ++j) {
    const InterfaceError& one = certificate.interface[j];
    CHECK(one.static_error * one.static_flexibility ==
          Approx(missing(static_cast<Eigen::Index>(j))).epsilon(1e-6));
  }
  // Below its lowest free mode it has a bound.
  design.reduction.highest_hz = 0.5 * expected(0);
  CHECK(make_superelement(design).certificate->is_bounded());
}

// A reduced body with the soft modes of its certificate, and the full model, at the interface and the
// reference node: these are all freedoms that a vehicle's stiffness acts on.
struct SoftBody {
  Design design;
  Superelement body;
  Eigen::MatrixXd F;
  double cutoff = 0.0;  // λ_c
};

SoftBody make_soft_body(std::uint64_t seed) {
  SoftBody soft{.design = testing::make_random_design(seed, 0.05), .body = {}, .F = {}};
  Superelement& body = soft.body = make_superelement(soft.design);
  soft.F.resize(body.certificate->soft_loads.rows(), body.certificate->soft_loads.cols() + 3);
  soft.F << body.certificate->soft_loads, body.certificate->soft_reference;
  soft.cutoff = std::pow(kTwoPi * body.certificate->cutoff_hz, 2);
  const auto point = static_cast<int>(body.points.size());
  body.points.push_back({.name = "held", .node = soft.design.reference_node});
  for (const int freedom : {0, 1, 2}) {
    soft.design.reduction.interface.push_back({point, soft.design.reference_node, freedom});
    body.certificate->interface.push_back({.point = point, .freedom = freedom});
  }
  return soft;
}

// The symmetric part of a flexibility, for unit loads scaled to equal flexibilities of the body at s.
Eigen::MatrixXd scale_flexibility(const Eigen::MatrixXd& flexibility, const Eigen::MatrixXd& H) {
  const Eigen::VectorXd scale = H.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * flexibility * scale.asDiagonal();
  return 0.5 * (scaled + scaled.transpose());
}

// H_r + Fᵀ(λ_c − s)⁻¹F − H has no negative eigenvalue, H from the full model.
TEST_CASE("the soft twin is softer than the body all over the band, with its reference node") {
  for (const std::uint64_t seed : {0, 5, 11}) {
    const SoftBody soft = make_soft_body(seed);
    REQUIRE(soft.F.rows() > 0);
    const testing::FreeBodyTruth truth(soft.design.model);
    for (int step = 0; step <= 20; ++step) {
      const double s = std::pow(kTwoPi * soft.body.certificate->highest_hz * step / 20.0, 2);
      const Eigen::MatrixXd H = truth.calc_flexibility(s, soft.design.reduction.interface).real();
      const Eigen::MatrixXd flexibility =
          testing::calc_flexibility(soft.body, s) + soft.F.transpose() * soft.F / (soft.cutoff - s);
      const Eigen::MatrixXd difference = scale_flexibility(flexibility - H, H);
      CHECK(difference.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > -1e-7);
    }
  }
}

// What the reduced body misses of ∫(x u_x + y u_y) dm, of the elastic displacement u at rest under the load
// M (x, y, 0): Σ (φᵀM(x, y, 0))²/ω² over all modes of the full model, less the same of the basis.
double calc_missed_radial(const SoftBody& soft, const testing::FreeBodyTruth& truth) {
  const fem::Mesh& mesh = soft.design.model.mesh;
  Eigen::VectorXd radial = Eigen::VectorXd::Zero(truth.mass().rows());
  for (int i = 0; i < mesh.num_nodes(); ++i)
    radial.segment<2>(3 * i) =
        mesh.node_positions.col(i) - mesh.node_positions.col(soft.design.reference_node);
  const Eigen::VectorXd shares = truth.shapes().transpose() * truth.mass() * radial;
  const Eigen::Index elastic = shares.size() - 3;
  const double all = shares.tail(elastic).cwiseAbs2().dot(truth.omega_squared().tail(elastic).cwiseInverse());

  const InertiaInvariants& inertia = soft.body.inertia;
  const Eigen::MatrixXd mass = calc_mass_matrix(inertia);
  const Eigen::MatrixXd momenta = mass.topRightCorner(3, soft.body.num_modes());
  const Eigen::MatrixXd frame = (mass.topLeftCorner<3, 3>().inverse() * momenta).topRows(2);
  const Eigen::VectorXd kept = (inertia.d - inertia.first_moment.transpose() * frame).transpose();
  return all - kept.dot(soft.body.stiffness.partialPivLu().solve(kept));
}

// H_r + Fᵀ(w/λ_c)F = H at s = 0.
TEST_CASE("with the shares at rest the soft modes give what the basis misses there") {
  for (const std::uint64_t seed : {0, 5, 11}) {
    const SoftBody soft = make_soft_body(seed);
    const Eigen::VectorXd& share = soft.body.certificate->soft_static_share;
    const Eigen::VectorXd& radial = soft.body.certificate->soft_radial;
    REQUIRE(share.size() == soft.F.rows());
    CHECK(share.minCoeff() >= 0.0);
    CHECK(share.maxCoeff() > 0.1);
    CHECK(share.maxCoeff() <= 1.0);
    const testing::FreeBodyTruth truth(soft.design.model);
    const Eigen::MatrixXd H = truth.calc_flexibility_at_rest(soft.design.reduction.interface);
    const Eigen::MatrixXd missed = H - testing::calc_flexibility(soft.body, 0.0);
    const Eigen::MatrixXd found = soft.F.transpose() * share.asDiagonal() * soft.F / soft.cutoff;
    CHECK(scale_flexibility(missed, H).norm() > 1e-4);
    CHECK(scale_flexibility(found - missed, H).norm() < 1e-8);
    CHECK(radial.cwiseAbs2().dot(share) / soft.cutoff ==
          Approx(calc_missed_radial(soft, truth)).epsilon(1e-4));
  }
}

TEST_CASE("a basis with all motions of the model misses nothing") {
  Design design = testing::make_random_design(7, 0.01);
  design.reduction.basis = BasisKind::kClamped;
  design.modes = {.wanted = AllModes{}};
  const Certificate certificate = *make_superelement(design).certificate;
  CHECK(certificate.largest_error() == 0.0);
  CHECK(certificate.cutoff_hz == 0.0);
  CHECK(certificate.free_error.maxCoeff() == 0.0);
}

}  // namespace
}  // namespace sprung::reduce

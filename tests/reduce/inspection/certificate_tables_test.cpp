#include "reduce/inspection/certificate_tables.h"

#include <cmath>

#include "reduce/inspection/superelement_tables.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using Catch::Matchers::StartsWith;

TEST_CASE("a certificate is told in a line: bound, band, worst freedom") {
  Superelement body = make_superelement(testing::make_random_design(2, 0.05));
  Certificate& certificate = *body.certificate;
  certificate.highest_hz = 60.0;
  for (InterfaceError& one : certificate.interface) one.error = 1e-4;
  certificate.interface[1].error = 0.0091;
  certificate.interface[1].worst_hz = 60.0;
  CHECK(format_certificate_line(body) ==
        "interface flexibility within 0.91 % up to 60 Hz (proved, of this mesh); worst: p0 y at 60 Hz");
  for (InterfaceError& one : certificate.interface) one.error = 1e-12;
  CHECK_THAT(format_certificate_line(body), StartsWith("interface flexibility within < 1e-06 % up to 60 Hz"));
  CHECK_THAT(format_modes(body), Contains("residual") && Contains("no frequency of the body"));
  CHECK_THAT(format_certificate(body), Contains("p0 rotation") || Contains("p0 y"));
}

TEST_CASE("a certificate without a bound says why, and how poor the basis is at rest") {
  Design design = testing::make_random_design(4, 0.01);
  design.reduction.basis = BasisKind::kClamped;
  design.modes = {.wanted = ModeCount{8}};
  const Eigen::VectorXd free = testing::FreeBodyTruth(design.model).calc_frequencies();
  design.reduction.highest_hz = 1.2 * free(0);
  const Superelement body = make_superelement(design);
  CHECK_THAT(format_certificate_line(body), StartsWith("interface flexibility without a bound up to ") &&
                                                Contains("% off; at rest within "));
  CHECK_THAT(format_certificate(body), Contains("No number can bound the band"));
}

// Errors in an order in which neither the first nor the last one is the largest, and a larger one above the
// band.
TEST_CASE(
    "the line of a certificate without a bound names the frequency that is the most wrong in the band") {
  Superelement body = make_superelement(testing::make_random_design(2, 0.05));
  Certificate& certificate = *body.certificate;
  certificate.highest_hz = 80.0;
  certificate.free_hz = Eigen::Vector4d(18.5, 55.0, 72.7, 110.0);
  certificate.free_error = Eigen::Vector4d(0.00082, 0.17, 0.02, 0.4);
  for (InterfaceError& one : certificate.interface) one.error = kUnbounded;
  CHECK_THAT(format_certificate_line(body),
             Contains(": the free mode at 55 Hz is 17 % off, the most in the band; at rest within "));
  certificate.free_error(2) = kUnbounded;
  CHECK_THAT(format_certificate_line(body),
             Contains(": the free mode at 72.7 Hz is missing, the most in the band; at rest within "));
  certificate.free_error = Eigen::Vector4d(0.01, 0.0, 0.0, 0.4);
  certificate.highest_hz = 20.0;
  CHECK_THAT(format_certificate_line(body),
             Contains(": the free mode at 18.5 Hz is 1 % off; at rest within "));
}

// The free damping of clamped modes by a modal test: with all modes of the model, C is known, and the free
// modes are those of the truth.
TEST_CASE("the damping of clamped modes on the free body is that of its free modes") {
  Design design = testing::make_random_design(4, 0.01);
  design.reduction.basis = BasisKind::kClamped;
  design.modes = {.wanted = AllModes{}};
  const Superelement body = make_superelement(design);
  const std::optional<FreeModes> free = calc_free_modes(body);
  REQUIRE(free);
  const Eigen::VectorXd expected = testing::FreeBodyTruth(design.model).calc_frequencies().head(6);
  CHECK((free->frequency_hz.head(6).cwiseQuotient(expected).array() - 1.0).abs().maxCoeff() < 1e-8);
  CHECK((free->damping_ratio.head(6).array() > 0.0).all());
  CHECK(std::abs(free->damping_ratio(0) / 0.02 - 1.0) > 0.01);  // it depends on the clamped place
  CHECK_THAT(format_free_damping(body), Contains("as a modal test measures it"));

  design.reduction.basis = BasisKind::kFree;
  const Superelement certified = make_superelement(design);
  const std::optional<FreeModes> modes = calc_free_modes(certified);
  REQUIRE(modes);
  CHECK((modes->damping_ratio.array() / 0.02 - 1.0).abs().maxCoeff() < 1e-9);
  CHECK(format_free_damping(certified).empty());
}

}  // namespace
}  // namespace sprung::reduce

#include <fmt/format.h>

#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/sensitivity/sensitivity_cases.h"

namespace sprung::reduce {
namespace {

// A frame on the scale of a crane, with a stiff spring.
constexpr const char* kWideFrame = R"(
theory = "timoshenko"
[materials.alloy]
youngs_modulus = 1.375e11
density = 780.0
poissons_ratio = 0.365
[sections.chord]
material = "alloy"
count = 2
area = 0.0946
second_moment = 0.0113
shear_coefficient = 0.5
[sections.brace]
material = "alloy"
count = 2
shape = "rectangle"
width = 0.1
height = 0.291
[points]
p0 = [0.44, -9.5]
p1 = [7.8, -0.05]
p2 = [-6.26, 6.88]
p3 = [11.9, 0.95]
p4 = [5.9, 12.25]
p5 = [-11.7, 2.46]
[[lines]]
through = ["p0", "p1", "p2"]
section = "chord"
elements = 3
[[lines]]
through = ["p2", "p3"]
section = "chord"
elements = 4
[[lines]]
through = ["p1", "p4"]
section = "chord"
elements = 1
[[lines]]
through = ["p0", "p5"]
section = "chord"
elements = 4
[[lines]]
through = ["p2", "p4"]
section = "brace"
elements = 4
[[springs]]
from = "p3"
to = "p1"
axial_stiffness = 7.7e7
rotational_stiffness = 1.61e9
transverse_stiffness = 9.4e8
[[point_masses]]
point = "p3"
mass = 6.57
[reference]
point = "p0"
[interface]
p1 = "xyr"
p2 = "x"
p3 = "xr"
p5 = "xyr"
[reduction]
highest_frequency = 33.0
tolerance = 0.0014
[modes]
damping_ratio = 0.02
)";

// Expected: certificates of bodies made anew, as above. Their number of residual vectors stays the same, and
// the parts of the band on which their bounds were made: else the values would jump.
void check_certificate_rates(const DesignSource& source, double step) {
  const DesignSensitivity sensitivity = calc_all(source, 1);
  const Superelement built = make_superelement(read_design(source));
  const Eigen::VectorXd& share = sensitivity.value.certificate;
  REQUIRE(share.size() == std::ssize(built.certificate->interface));
  for (Eigen::Index j = 0; j < share.size(); ++j)
    CHECK(share(j) == Approx(built.certificate->interface[static_cast<std::size_t>(j)].error).epsilon(1e-6));
  for (const ParameterSensitivity& one : sensitivity.parameters) {
    const DesignParameter& parameter = one.parameter;
    const double scale = parameter.is_coordinate ? 1.0 : parameter.value;
    const auto certificate = [&](double h) -> Eigen::VectorXd {
      DesignSource changed = source;
      changed.overrides.push_back(fmt::format("{}={:.17g}", parameter.key, parameter.value + h * scale));
      const DesignSensitivity at = calc_sensitivity(read_design(changed), {}, 1);
      return at.value.certificate;
    };
    const auto difference = [&](double h) -> Eigen::VectorXd {
      return (certificate(h) - certificate(-h)) / (2.0 * h);
    };
    const Eigen::VectorXd expected = (4.0 * difference(step) - difference(2.0 * step)) / 3.0;
    INFO(parameter.key);
    CHECK((scale * one.derivative.certificate - expected).cwiseQuotient(share).cwiseAbs().maxCoeff() < 1e-5);
  }
}

TEST_CASE("derivatives of the certificate are the differences of certificates made anew") {
  const DesignSource source = write_design("frame.toml", kFrame);
  CHECK(calc_all(source, 1).value.certificate.minCoeff() > 1e-4);
  check_certificate_rates(source, 2e-4);
}

// Eleven residual vectors for a frequency far above the lowest mode, each made from all earlier ones:
// rounding must not grow along them.
TEST_CASE("derivatives of a certificate of many residual vectors are those differences as well") {
  check_certificate_rates(write_design("wide.toml", kWideFrame), 2e-4);
}

// Modulus and density keep the shapes of the modes, so that all of K'φ and M'φ is of the modes. For the same
// frequencies the certificate depends on their ratio alone, as it does on area and second moment, in
// proportion, over the mass of a length, which the area alone moves.
TEST_CASE("the certificate of a uniform beam has derivatives by numbers that leave the modes' shapes") {
  const DesignSensitivity sensitivity = calc_all(write_design("beam.toml", kBeam), 1);
  const Eigen::VectorXd& share = sensitivity.value.certificate;
  const auto relative = [&](const std::string& key) -> Eigen::VectorXd {
    const ParameterSensitivity& one = find(sensitivity, key);
    return (one.parameter.value * one.derivative.certificate).cwiseQuotient(share);
  };
  const Eigen::VectorXd modulus = relative("materials.steel.youngs_modulus");
  CHECK(modulus.cwiseAbs().maxCoeff() > 1.0);
  CHECK((modulus + relative("materials.steel.density")).cwiseAbs().maxCoeff() < 1e-8);
  const Eigen::VectorXd section = relative("sections.beam.area") + relative("sections.beam.second_moment");
  CHECK(section.cwiseAbs().maxCoeff() < 1e-8);
}

// A clamped basis has free modes in its band, and so no bound.
TEST_CASE("a basis that is not free has no derivative of its certificate") {
  std::string text = kFrame;
  text.replace(text.find("highest_frequency = 100.0"), 25, "basis = \"clamped\"");
  text.replace(text.find("[modes]"), 7, "[modes]\ncount = 4");
  CHECK(calc_all(write_design("clamped.toml", text), 1).value.certificate.size() == 0);
}

}  // namespace
}  // namespace sprung::reduce

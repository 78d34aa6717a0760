#include "dynamics/response/adaptive_integral.h"

#include <cmath>

#include "tests/catch.h"

using namespace sprung;
using Eigen::VectorXd;

namespace {

VectorXd no_floor(const VectorXd& values) {
  return VectorXd::Zero(values.size());
}

}  // namespace

TEST_CASE("Integrals of several functions at once, a sharp peak among them", "[analysis]") {
  constexpr double kWidth = 1e-6, kPeak = 0.3217;
  const auto function = [](double x) {
    return Eigen::Vector3d(std::exp(x), kWidth / ((x - kPeak) * (x - kPeak) + kWidth * kWidth), 0.0);
  };
  const auto integral = dynamics::integrate(function, {0.0, 0.25, 1.0}, 1e-9, no_floor);
  CHECK(integral.converged);
  CHECK(integral.value[0] == Approx(std::exp(1.0) - 1.0).epsilon(1e-13));
  CHECK(integral.value[1] ==
        Approx(std::atan((1.0 - kPeak) / kWidth) + std::atan(kPeak / kWidth)).epsilon(1e-8));
  CHECK(integral.value[2] == 0.0);
}

TEST_CASE("An integral that does not exist is reported with its place", "[analysis]") {
  const auto pole = [](double x) { return VectorXd::Constant(1, 1.0 / ((x - 0.6) * (x - 0.6))); };
  const auto integral = dynamics::integrate(pole, {0.0, 1.0}, 1e-6, no_floor);
  CHECK_FALSE(integral.converged);
  CHECK(integral.worst == Approx(0.6).margin(1e-6));
}

TEST_CASE("Errors below the floor cause no refinement", "[analysis]") {
  int evaluations = 0;
  const auto noisy = [&](double x) {
    ++evaluations;
    return Eigen::Vector2d(1.0, 1e-30 * (1.0 + std::sin(1e9 * x)));
  };
  const auto integral = dynamics::integrate(noisy, {0.0, 1.0}, 1e-9, [](const VectorXd& values) {
    return VectorXd::Constant(values.size(), 1e-20 * values.maxCoeff());
  });
  CHECK(integral.converged);
  CHECK(evaluations == 15);
}

TEST_CASE("An integral has two ends", "[analysis]") {
  CHECK_THROWS_WITH(dynamics::integrate([](double) { return VectorXd::Zero(1); }, {0.0}, 1e-6, no_floor),
                    Contains("2 breaks"));
}

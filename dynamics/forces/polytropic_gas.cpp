#include "dynamics/forces/polytropic_gas.h"

#include <cmath>
#include <numbers>

namespace sprung::dynamics {

namespace {

constexpr double kAirConstant = 287.05;    // of air [J/(kg·K)]
constexpr double kCriticalRatio = 0.5283;  // of pressures, at which the flow of air becomes sonic
constexpr double kSonicFlow = 0.6847;      // ṁ/(A √(p ρ)) of sonic flow
constexpr double kLaminarShare = 0.004;    // of the pressure difference of sonic flow: linear below
constexpr int kImbalances = 400;           // points of the normal distribution
constexpr double kLargestImbalance = 6.0;  // r.m.s.

}  // namespace

PolytropicGas::PolytropicGas(double exponent, double pressure, double ambient_pressure, double temperature)
    : exponent_(exponent),
      ambient_pressure_(ambient_pressure),
      ambient_density_(pressure / (kAirConstant * temperature) /
                       std::pow(pressure / ambient_pressure, 1.0 / exponent)) {}

double PolytropicGas::density_at(double pressure) const {
  return std::pow(pressure / ambient_pressure_, 1.0 / exponent_);
}

double PolytropicGas::pressure(double x) const {
  return ambient_pressure_ * std::pow(x, exponent_);
}

// (x^(n − 1) − 1)/(n − 1), which is ln x for n = 1.
double PolytropicGas::relative_energy(double x) const {
  const double above = exponent_ - 1.0;
  return above == 0.0 ? std::log(x) : std::expm1(above * std::log(x)) / above;
}

double PolytropicGas::energy(double x) const {
  return ambient_pressure_ / ambient_density_ * (relative_energy(x) + 1.0 / x - 1.0);
}

double PolytropicGas::enthalpy(double x) const {
  return exponent_ * ambient_pressure_ / ambient_density_ * relative_energy(x);
}

double PolytropicGas::mass_flow(double area, double x_1, double x_2) const {
  const double w = std::log(x_1 / x_2);
  const double x = w > 0.0 ? x_1 : x_2;
  // Pressure difference as a share of that of sonic flow.
  const double y = -std::expm1(-exponent_ * std::abs(w)) / (1.0 - kCriticalRatio);
  const double share = y < 1.0
                           ? y * std::sqrt(2.0 - y) / std::pow(y * y + kLaminarShare * kLaminarShare, 0.25)
                           : 1.0 / std::pow(1.0 + kLaminarShare * kLaminarShare, 0.25);
  const double sonic =
      area * kSonicFlow * std::sqrt(ambient_pressure_ * ambient_density_ * std::pow(x, exponent_ + 1.0));
  return std::copysign(sonic * share, w);
}

double PolytropicGas::calc_mean_gain(double area, double x_1, double sigma) const {
  const double width = kLargestImbalance / kImbalances;
  double sum = 0.0;
  for (int i = 0; i < kImbalances; ++i) {
    const double u = (i + 0.5) * width;
    sum += u * mass_flow(area, x_1, x_1 * std::exp(-u * sigma)) * width * std::exp(-0.5 * u * u);
  }
  return 2.0 * sum / (std::sqrt(2.0 * std::numbers::pi) * sigma);
}

}  // namespace sprung::dynamics

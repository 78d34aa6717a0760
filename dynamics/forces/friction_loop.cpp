#include "dynamics/forces/friction_loop.h"

#include <cmath>
#include <numbers>

namespace sprung::dynamics {

namespace {

using std::numbers::pi;

constexpr int kPhases = 400;               // of half a loop
constexpr int kAmplitudes = 400;           // of the Rayleigh distribution
constexpr double kLargestAmplitude = 7.0;  // r.m.s.: the rest has a share of 1e-9
constexpr double kSmallReach = 1e-4;       // below it tanh(x)/x is 1 − x²/3

}  // namespace

FrictionHarmonic calc_friction_harmonic(double reach) {
  if (reach < kSmallReach) return {.in_phase = reach, .ahead = 4.0 / pi * reach * reach / 3.0};
  const double corner = std::tanh(reach);  // p at the upper end of the loop
  // Over the way up from −A, by the midpoint rule; the way down is its image.
  double sum = 0.0;
  for (int i = 0; i < kPhases; ++i) {
    const double phase = pi * ((i + 0.5) / kPhases - 0.5);
    const double p = 1.0 - (1.0 + corner) * std::exp(-reach * (1.0 + std::sin(phase)));
    sum += p * std::sin(phase);
  }
  return {.in_phase = 2.0 * sum / kPhases, .ahead = 4.0 / pi * (1.0 - corner / reach)};
}

LinearFriction linearise_friction(double rms_deflection, double rms_rate, double presliding_deflection) {
  // Mean of A² times the stiffness of a loop, for σ = 1; A² has the mean 2.
  double in_phase = 0.0, ahead = 0.0;
  const double width = kLargestAmplitude / kAmplitudes;
  for (int i = 0; i < kAmplitudes; ++i) {
    const double A = (i + 0.5) * width;
    const double weight = 0.5 * A * width * A * std::exp(-0.5 * A * A);  // A²/(2A) of the density
    const FrictionHarmonic harmonic = calc_friction_harmonic(A * rms_deflection / presliding_deflection);
    in_phase += weight * harmonic.in_phase;
    ahead += weight * harmonic.ahead;
  }
  const double omega = rms_rate / rms_deflection;
  const double ratio = ahead / in_phase;  // decay/ω
  const double by_reach = in_phase * presliding_deflection / rms_deflection;
  return {.gain = by_reach * (1.0 + ratio * ratio), .decay = omega * ratio};
}

}  // namespace sprung::dynamics

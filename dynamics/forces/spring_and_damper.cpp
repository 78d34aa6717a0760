#include "dynamics/forces/spring_and_damper.h"

#include "dynamics/functions/mean_slope.h"

namespace sprung::dynamics {

namespace {

// How far a piece is used beyond its end: too little to be seen in a force or a torque.
constexpr double kDeflectionDeadBand = 1e-9;  // m or rad
constexpr double kRateDeadBand = 1e-6;        // m/s or rad/s

// R.m.s. rate that the linearisation for random motion begins with.
constexpr double kUsualDamperRate = 0.1;  // m/s or rad/s
constexpr std::size_t kRateChannel = 2;   // of both kinds

}  // namespace

double SpringAndDamper::calc_damper_force(const Instant& instant, int branch, double rate) const {
  if (!instant.rate_slopes.empty()) return instant.rate_slopes[0] * rate;
  return multiplicity() * damper().value_in_piece(branch, rate);
}

double SpringAndDamper::calc_damper_force(const Instant& instant, double rate) const {
  if (!instant.rate_slopes.empty()) return instant.rate_slopes[0] * rate;
  return multiplicity() * damper().value(rate);
}

RandomLaws SpringAndDamper::linearise_for_random_motion(const Instant& /*at_rest*/,
                                                        std::span<const int> /*branches*/,
                                                        std::span<const double> rms) const {
  if (has_one_slope(damper())) return {};
  const double rate = rms.empty() ? kUsualDamperRate : rms[kRateChannel];
  return {.rate_slopes = {multiplicity() * calc_mean_slope(damper(), rate)}};
}

void SpringAndDamper::choose_branches(const Instant& instant, std::span<int> branches) const {
  const Deflection d = calc_deflection(instant);
  branches[0] = spring().choose_piece(branches[0], d.value, kDeflectionDeadBand);
  branches[1] = damper().choose_piece(branches[1], d.rate, kRateDeadBand);
}

void SpringAndDamper::calc_switches(const Instant& instant, std::span<const int> branches,
                                    std::span<double> values) const {
  const Deflection d = calc_deflection(instant);
  spring().calc_piece_switches(branches[0], d.value, kDeflectionDeadBand, values);
  damper().calc_piece_switches(branches[1], d.rate, kRateDeadBand,
                               values.subspan(static_cast<std::size_t>(spring().num_switches())));
}

}  // namespace sprung::dynamics

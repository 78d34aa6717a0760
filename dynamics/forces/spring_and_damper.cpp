#include "dynamics/forces/spring_and_damper.h"

namespace sprung::dynamics {

namespace {

// How far a piece is used beyond its end: too little to be seen in a force or a torque.
constexpr double kDeflectionDeadBand = 1e-9;  // m or rad
constexpr double kRateDeadBand = 1e-6;        // m/s or rad/s

}  // namespace

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

#include "dynamics/adaptivity/neglect_record.h"

namespace sprung::dynamics {

NeglectRecord::NeglectRecord(const ModeIndicator& indicator, double start_time)
    : peaks_(indicator.num_modes()) {
  for (Peaks& peaks : peaks_)
    peaks.acceleration.assign(indicator.sizes().num_points(), {.value = 0.0, .time = start_time});
}

void NeglectRecord::add_step(const ModeIndicator& indicator, const std::vector<ModeAmplitude>& largest) {
  const auto record_peak = [&](double value, Peak& peak) {
    if (value > peak.value) peak = {.value = value, .time = indicator.time()};
  };
  for (std::size_t j = 0; j < peaks_.size(); ++j) {
    record_peak(indicator.calc_deflection(j, largest[j]), peaks_[j].deflection);
    for (std::size_t i = 0; i < peaks_[j].acceleration.size(); ++i) {
      record_peak(indicator.calc_acceleration(j, i, largest[j]), peaks_[j].acceleration[i]);
    }
  }
}

WorstNeglect NeglectRecord::find_worst(const ModeIndicator& indicator) const {
  WorstNeglect worst;
  const auto take = [](double share, const Peak& peak, int coordinate, LargestShare& largest) {
    if (share > largest.share) largest = {share, coordinate, peak.time};
  };
  for (std::size_t j = 0; j < peaks_.size(); ++j) {
    const int coordinate = indicator.modal_coordinates()[j];
    take(indicator.sizes().calc_deflection_share(peaks_[j].deflection.value), peaks_[j].deflection,
         coordinate, worst.deflection);
    for (std::size_t i = 0; i < peaks_[j].acceleration.size(); ++i) {
      const Peak& peak = peaks_[j].acceleration[i];
      take(indicator.sizes().calc_acceleration_share(i, peak.value), peak, coordinate, worst.acceleration);
    }
  }
  return worst;
}

void NeglectRecord::restore(support::ByteReader& bytes, const ModeIndicator& indicator) {
  transfer(bytes, *this);
  if (peaks_.size() != indicator.num_modes()) throw support::DamagedBytes();
  for (const Peaks& peaks : peaks_) {
    if (peaks.acceleration.size() != indicator.sizes().num_points()) throw support::DamagedBytes();
  }
}

}  // namespace sprung::dynamics

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
  for (std::size_t j = 0; j < peaks_.size(); ++j) {
    const std::vector<Peak>& acceleration = peaks_[j].acceleration;
    const ModeShare share = indicator.sizes().calc_share(
        peaks_[j].deflection.value, [&](std::size_t point) { return acceleration[point].value; });
    if (!(share.worst() > worst.share.worst())) continue;
    worst = {share, indicator.modal_coordinates()[j], peaks_[j].deflection.time};
    if (share.deflection > share.acceleration) continue;
    for (std::size_t i = 0; i < acceleration.size(); ++i) {  // the point whose share it is
      const ModeShare alone = indicator.sizes().calc_share(
          0.0, [&](std::size_t point) { return point == i ? acceleration[i].value : 0.0; });
      if (alone.acceleration == share.acceleration) worst.time = acceleration[i].time;
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

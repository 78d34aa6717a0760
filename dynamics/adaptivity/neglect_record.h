#pragma once

#include <algorithm>
#include <vector>

#include "dynamics/adaptivity/mode_indicator.h"

namespace sprung::dynamics {

/// The largest share that a mode left out has had in a run, and which mode that was.
struct LargestShare {
  double share = 0.0;
  int coordinate = -1;  ///< of the full model, −1: none was left out
  double time = 0.0;    ///< [s]
};

/// By deflection and by acceleration: these may be different modes.
struct WorstNeglect {
  LargestShare deflection, acceleration;
  double share() const { return std::max(deflection.share, acceleration.share); }
};

/// Records the largest that each mode would have done while it was left out, by the set of modes that was
/// active then.
class NeglectRecord {
 public:
  NeglectRecord(const ModeIndicator& indicator, double start_time);
  /// Records a step that is final.
  /// @param indicator  at its end   @param largest  amplitudes in it, of each mode
  void add_step(const ModeIndicator& indicator, const std::vector<ModeAmplitude>& largest);
  /// As shares of the largest sizes in all of the run. With modes that join and leave never more than the
  /// recall threshold, as steps in which it was passed have been taken back.
  WorstNeglect find_worst(const ModeIndicator& indicator) const;

  void save(support::ByteWriter& bytes) const { transfer(bytes, *this); }
  /// @param indicator  of the same model   @throws support::DamagedBytes
  void restore(support::ByteReader& bytes, const ModeIndicator& indicator);

 private:
  struct Peak {
    double value = 0.0, time = 0.0;
  };
  struct Peaks {
    Peak deflection;                 // [m]
    std::vector<Peak> acceleration;  // of each point asked for [m/s²]
  };
  template <class Bytes, class Record>
  static void transfer(Bytes& bytes, Record& record) {
    const auto transfer_peak = [&](auto& peak) {
      bytes.transfer(peak.value);
      bytes.transfer(peak.time);
    };
    bytes.transfer_items(record.peaks_, [&](auto& peaks) {
      transfer_peak(peaks.deflection);
      bytes.transfer_items(peaks.acceleration, transfer_peak);
    });
  }
  std::vector<Peaks> peaks_;  // of each mode
};

}  // namespace sprung::dynamics

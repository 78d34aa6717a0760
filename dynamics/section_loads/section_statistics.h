#pragma once

#include <array>
#include <vector>

#include "dynamics/section_loads/vehicle_sections.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

/// Where and when a quantity along the beams of a body has had its largest size.
struct SectionPeak {
  double value = 0.0;  ///< signed [N, N, N·m]
  int station = 0;
  double time = 0.0;  ///< [s]
};

/// As files and JSON call SectionPeaks::Quantity.
inline constexpr std::array<const char*, 3> kQuantityNames{"axial", "shear", "moment"};

/// The largest axial force, shear force and bending moment of a body in a run, and how much the two ways to
/// find them differ.
struct SectionPeaks {
  enum Quantity { kAxial, kShear, kMoment };
  std::array<SectionPeak, 3> from_modes, from_loads, difference;
  /// What the modes lack of a bending moment (section_loads, eq. 3); the station is the element's first end.
  SectionPeak missing_moment;
  /// Of the named points: the largest deflection; and what the modes lack of a deflection along x or y
  /// (section_loads, eq. 4). The station is 3 × point + direction [m].
  SectionPeak deflection, missing_deflection;
  /// Largest values of what all vectors of the superelement would lack of both (section_loads, eq. 9).
  double basis_moment = 0.0, basis_deflection = 0.0;
  double length = 0.0;  ///< of the body [m]
  double weight = 0.0;  ///< of the body [N]

  /// What the modes lack as a share of the largest value, of moments that from the loads where there is one;
  /// 0 where all are 0, or rounding errors beside the body's weight and its axial and shear forces.
  double missing_moment_share() const;
  double missing_deflection_share() const;
  /// The same shares of what all vectors of the superelement would lack.
  double basis_moment_share() const;
  double basis_deflection_share() const;
  /// Moments up to this one are rounding errors beside weight, axial and shear forces of the body [N·m].
  double rounding_moment() const;
};

/// The largest section loads of a run, over outputs that are added one by one.
class SectionStatistics {
 public:
  /// @param sections  has to outlive this
  explicit SectionStatistics(const VehicleSections& sections);

  void add(double time);  ///< the present values of the sections
  const VehicleSections& sections() const { return *sections_; }
  /// One for each of the sections' bodies.
  const std::vector<SectionPeaks>& peaks() const { return peaks_; }

  template <class Bytes, class Statistics>
  static void transfer(Bytes& bytes, Statistics& statistics) {
    for (auto& peaks : statistics.peaks_) {
      const auto transfer_peak = [&](auto& peak) {
        bytes.transfer(peak.value);
        bytes.transfer(peak.station);
        bytes.transfer(peak.time);
      };
      for (auto* three : {&peaks.from_modes, &peaks.from_loads, &peaks.difference}) {
        for (auto& peak : *three) transfer_peak(peak);
      }
      transfer_peak(peaks.missing_moment);
      transfer_peak(peaks.deflection);
      transfer_peak(peaks.missing_deflection);
      bytes.transfer(peaks.basis_moment);
      bytes.transfer(peaks.basis_deflection);
    }
  }

 private:
  const VehicleSections* sections_;
  std::vector<SectionPeaks> peaks_;
};

}  // namespace sprung::dynamics

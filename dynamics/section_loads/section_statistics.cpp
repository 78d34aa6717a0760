#include "dynamics/section_loads/section_statistics.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

void add_values(const Eigen::Ref<const Eigen::Matrix3Xd>& values, double time,
                std::array<SectionPeak, 3>& peaks) {
  for (Eigen::Index station = 0; station < values.cols(); ++station) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      SectionPeak& peak = peaks[static_cast<std::size_t>(i)];
      const double value = values(i, station);
      if (std::abs(value) > std::abs(peak.value)) peak = {value, static_cast<int>(station), time};
    }
  }
}

constexpr double kRoundingShare = 1e-9;  // of a moment or deflection, beside what the forces could cause

double calc_share(const SectionPeak& part, const SectionPeak& whole) {
  if (part.value == 0.0) return 0.0;
  return whole.value != 0.0 ? std::abs(part.value / whole.value) : 1.0;
}

// From the loads where there are some.
const std::array<SectionPeak, 3>& get_whole(const SectionPeaks& peaks) {
  const bool has_loads = peaks.from_loads[SectionPeaks::kMoment].value != 0.0;
  return has_loads ? peaks.from_loads : peaks.from_modes;
}

void add_deflections(const BodySections& body, double time, SectionPeaks& peaks) {
  for (Eigen::Index p = 0; p < body.deflections().cols(); ++p) {
    const double size = body.deflections().col(p).head<2>().norm();
    if (size > peaks.deflection.value) peaks.deflection = {size, static_cast<int>(3 * p), time};
    for (Eigen::Index direction = 0; direction < 2; ++direction) {
      const double missing = body.missing_deflections()(direction, p);
      if (std::abs(missing) > std::abs(peaks.missing_deflection.value))
        peaks.missing_deflection = {missing, static_cast<int>(3 * p + direction), time};
      peaks.basis_deflection =
          std::max(peaks.basis_deflection, std::abs(body.basis_missing_deflections()(direction, p)));
    }
  }
}

}  // namespace

double SectionPeaks::missing_moment_share() const {
  if (std::abs(missing_moment.value) <= rounding_moment()) return 0.0;
  return calc_share(missing_moment, get_whole(*this)[kMoment]);
}

double SectionPeaks::missing_deflection_share() const {
  if (std::abs(missing_deflection.value) <= kRoundingShare * length) return 0.0;
  return calc_share(missing_deflection, deflection);
}

double SectionPeaks::basis_moment_share() const {
  return calc_share({.value = basis_moment}, get_whole(*this)[kMoment]);
}

double SectionPeaks::basis_deflection_share() const {
  return calc_share({.value = basis_deflection}, deflection);
}

double SectionPeaks::rounding_moment() const {
  const std::array<SectionPeak, 3>& whole = get_whole(*this);
  const double force = std::max({weight, std::abs(whole[kAxial].value), std::abs(whole[kShear].value)});
  return kRoundingShare * length * force;
}

SectionStatistics::SectionStatistics(const VehicleSections& sections)
    : sections_(&sections), peaks_(sections.bodies().size()) {
  for (std::size_t b = 0; b < peaks_.size(); ++b) {
    peaks_[b].length = sections.bodies()[b].length();
    peaks_[b].weight = sections.bodies()[b].weight();
  }
}

void SectionStatistics::add(double time) {
  for (std::size_t b = 0; b < peaks_.size(); ++b) {
    const BodySections& body = sections_->bodies()[b];
    if (body.has_modes()) add_values(body.from_modes(), time, peaks_[b].from_modes);
    if (body.has_loads()) add_values(body.from_loads(), time, peaks_[b].from_loads);
    if (body.has_modes() && body.has_loads())
      add_values(body.from_loads() - body.from_modes(), time, peaks_[b].difference);
    if (!body.has_missing()) continue;
    SectionPeak& missing = peaks_[b].missing_moment;
    Eigen::Index element = 0;
    const double size = body.missing_moment().cwiseAbs().maxCoeff(&element);
    if (size > std::abs(missing.value))
      missing = {body.missing_moment()[element], static_cast<int>(2 * element), time};
    peaks_[b].basis_moment =
        std::max(peaks_[b].basis_moment, body.basis_missing_moment().cwiseAbs().maxCoeff());
    add_deflections(body, time, peaks_[b]);
  }
}

}  // namespace sprung::dynamics

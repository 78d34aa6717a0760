#include "dynamics/road/road_spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sprung::dynamics {

RoadSpectrum RoadSpectrum::power_law(double reference_density, double exponent) {
  if (!(reference_density > 0.0) || !std::isfinite(exponent)) {
    throw std::invalid_argument(
        fmt::format("RoadSpectrum::power_law: density must be > 0 m³ and the exponent finite, got {} and {}",
                    reference_density, exponent));
  }
  RoadSpectrum spectrum;
  const double at = std::log(kReferenceWavenumber);
  spectrum.log_wavenumber_ = {at, at + 1.0};
  spectrum.log_density_ = {std::log(reference_density), std::log(reference_density) - exponent};
  spectrum.highest_ = std::numeric_limits<double>::infinity();
  return spectrum;
}

RoadSpectrum RoadSpectrum::through_points(std::span<const double> wavenumber,
                                          std::span<const double> density) {
  if (wavenumber.size() < 2 || density.size() != wavenumber.size()) {
    throw std::invalid_argument(
        fmt::format("RoadSpectrum::through_points: needs 2 points or more, got {} and {}", wavenumber.size(),
                    density.size()));
  }
  RoadSpectrum spectrum;
  for (std::size_t i = 0; i < wavenumber.size(); ++i) {
    if (!(wavenumber[i] > (i == 0 ? 0.0 : wavenumber[i - 1])) || !(density[i] > 0.0)) {
      throw std::invalid_argument(
          fmt::format("RoadSpectrum::through_points: wavenumbers must ascend above 0 1/m and densities be > "
                      "0 m³, got {} and {}",
                      wavenumber[i], density[i]));
    }
    spectrum.log_wavenumber_.push_back(std::log(wavenumber[i]));
    spectrum.log_density_.push_back(std::log(density[i]));
  }
  spectrum.lowest_ = wavenumber.front();
  spectrum.highest_ = wavenumber.back();
  return spectrum;
}

void RoadSpectrum::limit_to(double lowest, double highest) {
  if (!(lowest >= 0.0) || !(highest > lowest)) {
    throw std::invalid_argument(
        fmt::format("RoadSpectrum::limit_to: must ascend from 0 1/m or more, got {} to {}", lowest, highest));
  }
  lowest_ = std::max(lowest_, lowest);
  highest_ = std::min(highest_, highest);
}

double RoadSpectrum::density(double wavenumber) const {
  if (!(wavenumber >= lowest_ && wavenumber <= highest_)) return 0.0;
  const double at = std::log(wavenumber);
  const auto above = std::upper_bound(log_wavenumber_.begin() + 1, log_wavenumber_.end() - 1, at);
  const auto i = static_cast<std::size_t>(above - log_wavenumber_.begin());
  const double u = (at - log_wavenumber_[i - 1]) / (log_wavenumber_[i] - log_wavenumber_[i - 1]);
  return std::exp(log_density_[i - 1] + u * (log_density_[i] - log_density_[i - 1]));
}

std::vector<double> RoadSpectrum::breaks() const {
  std::vector<double> breaks{lowest_, highest_};
  if (log_wavenumber_.size() > 2) {
    for (const double at : log_wavenumber_) breaks.push_back(std::exp(at));
  }
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(
      std::remove_if(breaks.begin(), breaks.end(),
                     [&](double n) { return !(n > 0.0 && n >= lowest_ && n <= highest_) || std::isinf(n); }),
      breaks.end());
  return breaks;
}

double calc_iso_density(char road_class) {
  if (road_class < 'A' || road_class > 'H') {
    throw std::invalid_argument(fmt::format("calc_iso_density: class must be A to H, got '{}'", road_class));
  }
  return 16e-6 * std::pow(4.0, road_class - 'A');
}

}  // namespace sprung::dynamics

#include "dynamics/response/random_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "dynamics/response/adaptive_integral.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kPanelTolerance = 1e-7;  // error of a panel, of the whole mean square
// Mean square that counts as zero, relative to the largest in the same unit.
constexpr double kNegligibleShare = 1e-18;
constexpr double kPanelsPerDecade = 6.0;
constexpr double kMostDelays = 20000.0;  // panels for the delay between the wheels

void check(double speed, const FrequencyRange& range) {
  if (!(speed > 0.0) || !(range.from > 0.0) || !(range.to > range.from)) {
    throw std::invalid_argument(
        fmt::format("random response: speed must be > 0 m/s and frequencies > 0 Hz and ascending, got {} "
                    "m/s, {} to {} Hz",
                    speed, range.from, range.to));
  }
}

// Distance along the road between the foremost and the rearmost input [m].
double calc_wheelbase(const LinearVehicle& vehicle) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const RoadInput& input : vehicle.inputs()) {
    first = std::min(first, input.distance);
    last = std::max(last, input.distance);
  }
  return vehicle.inputs().empty() ? 0.0 : last - first;
}

// Frequencies that divide the range into panels on each of which the spectrum is smooth, ascending.
std::vector<double> find_panel_ends(const RoadSpectrum& road, double speed, const FrequencyRange& range,
                                    const Eigen::VectorXcd& eigenvalues, double wheelbase) {
  std::vector<double> ends{range.from, range.to};
  const double decades = std::log10(range.to / range.from);
  const int count = static_cast<int>(std::ceil(kPanelsPerDecade * decades));
  for (int i = 1; i < count; ++i) ends.push_back(range.from * std::pow(10.0, decades * i / count));
  for (const double n : road.breaks()) ends.push_back(n * speed);
  for (const std::complex<double>& s : eigenvalues) {
    if (s.imag() <= 0.0) continue;
    const double peak = s.imag() / (2.0 * std::numbers::pi), width = -s.real() / (2.0 * std::numbers::pi);
    for (const double times : {-4.0, 0.0, 4.0}) ends.push_back(peak + times * width);
  }
  // |1 + e^{iωL/V}|² has the period V/L.
  const double period = speed / wheelbase;
  if (wheelbase > 0.0 && range.to < kMostDelays * period) {
    for (double f = period * std::ceil(range.from / period); f < range.to; f += period) ends.push_back(f);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(
      std::remove_if(ends.begin(), ends.end(), [&](double f) { return !(f >= range.from && f <= range.to); }),
      ends.end());
  ends.erase(std::unique(ends.begin(), ends.end(), [](double a, double b) { return b - a <= 1e-9 * b; }),
             ends.end());
  return ends;
}

[[noreturn]] void throw_undamped(const Eigen::VectorXcd& eigenvalues, double frequency_hz) {
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  std::complex<double> nearest = eigenvalues[0];
  for (const std::complex<double>& s : eigenvalues) {
    if (std::abs(s.imag() - omega) < std::abs(nearest.imag() - omega)) nearest = s;
  }
  throw support::NumericalError(fmt::format(
      "random response: the mean square does not converge near {:.6g} Hz, where a mode at {:.6g} Hz has "
      "{:.1e} of critical damping; give it damping, or leave it outside of the range of frequencies",
      frequency_hz, nearest.imag() / (2.0 * std::numbers::pi), -nearest.real() / std::abs(nearest)));
}

}  // namespace

Eigen::VectorXd calc_response_spectrum(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const RoadSpectrum& road, double speed, double frequency_hz) {
  const double density = road.density(frequency_hz / speed) / speed;
  return density * calc_response(vehicle, outputs, make_road_wave(frequency_hz, speed)).cwiseAbs2();
}

Eigen::VectorXd calc_root_mean_squares(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const RoadSpectrum& road, double speed, const FrequencyRange& range) {
  check(speed, range);
  const Eigen::VectorXcd eigenvalues = vehicle.solver().eigenvalues();
  std::vector<double> breaks = find_panel_ends(road, speed, range, eigenvalues, calc_wheelbase(vehicle));
  for (double& f : breaks) f = std::log(f);
  // Outputs of one unit are compared with the largest of them.
  const auto floors = [&](const Eigen::VectorXd& values) {
    std::map<std::string, double> largest;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      double& one = largest[outputs.units[static_cast<std::size_t>(i)]];
      one = std::max(one, values[i]);
    }
    Eigen::VectorXd floor(values.size());
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      floor[i] = kNegligibleShare * largest[outputs.units[static_cast<std::size_t>(i)]];
    }
    return floor;
  };
  const AdaptiveIntegral integral = integrate(
      [&](double log_frequency) {
        const double f = std::exp(log_frequency);
        return Eigen::VectorXd(f * calc_response_spectrum(vehicle, outputs, road, speed, f));
      },
      breaks, kPanelTolerance, floors);
  if (!integral.converged) throw_undamped(eigenvalues, std::exp(integral.worst));
  return integral.value.cwiseSqrt();
}

double calc_road_rms(const RoadSpectrum& road, double speed, const FrequencyRange& range) {
  check(speed, range);
  std::vector<double> breaks = find_panel_ends(road, speed, range, Eigen::VectorXcd(), 0.0);
  for (double& f : breaks) f = std::log(f);
  const AdaptiveIntegral integral = integrate(
      [&](double log_frequency) {
        const double n = std::exp(log_frequency) / speed;
        return Eigen::VectorXd::Constant(1, n * road.density(n));
      },
      breaks, kPanelTolerance,
      [](const Eigen::VectorXd& values) { return Eigen::VectorXd::Zero(values.size()); });
  return std::sqrt(integral.value[0]);
}

}  // namespace sprung::dynamics

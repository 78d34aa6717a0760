#include "dynamics/mode_choice/forcing_spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

namespace sprung::dynamics {

namespace {

using std::numbers::pi;

constexpr double kMostSamples = 1 << 22;
constexpr double kShortest = 1e-3;  // duration of the forcing where there is none, of the run
constexpr double kRest = 0.01;      // of its amplitude, to which a motion decays in the settling time

// Samples of the forcing during the run; afterwards its last value fades out over the first half of settling.
std::vector<double> sample(const std::function<double(double)>& value, double duration, double period,
                           Eigen::Index n) {
  const double fading = 0.5 * (period - duration);
  std::vector<double> samples(static_cast<std::size_t>(n));
  for (Eigen::Index j = 0; j < n; ++j) {
    const double t = period * static_cast<double>(j) / static_cast<double>(n);
    const double share = t <= duration           ? 1.0
                         : t < duration + fading ? 0.5 + 0.5 * std::cos(pi * (t - duration) / fading)
                                                 : 0.0;
    samples[static_cast<std::size_t>(j)] = share > 0.0 ? share * value(std::min(t, duration)) : 0.0;
  }
  return samples;
}

// Where the forcing jumps: by how much, and when.
struct ForcingJump {
  double time = 0.0, change = 0.0;
};

// Replaces the sample next to each jump by the mean over the time that belongs to it. Else the jump would
// seem to lie at a sample, up to half of their distance away.
void smooth_jumps(const std::vector<ForcingJump>& jumps, double duration, double period,
                  std::vector<double>& samples) {
  const double step = period / static_cast<double>(samples.size());
  for (const ForcingJump& jump : jumps) {
    if (!(jump.time > 0.0 && jump.time < duration)) continue;
    const auto j = static_cast<std::size_t>(std::lround(jump.time / step));
    if (j == samples.size()) continue;                               // it would belong to the next period
    const double place = jump.time / step - static_cast<double>(j);  // −½ … ½
    samples[j] += jump.change * (0.5 - place - (place <= 0.0 ? 1.0 : 0.0));
  }
}

bool changes_with_time(const ForceElement& force) {
  const std::vector<const TimeFunction*> functions = force.time_functions();
  return std::any_of(functions.begin(), functions.end(),
                     [](const TimeFunction* f) { return !f->is_constant(); });
}

// A component of force or torque on a marker that varies with time: 0: x, 1: y, 2: torque.
struct TimedForce {
  std::size_t force = 0;
  int marker = 0;
  int component = 0;
};

class TimedForces {
 public:
  TimedForces(const LinearVehicle& vehicle, const KnownForcing& forcing)
      : vehicle_(vehicle), wrenches_(vehicle.model().markers.size()) {
    if (forcing.is_road_alone) return;
    const Model& model = vehicle.model();
    for (std::size_t f = 0; f < model.forces.size(); ++f) {
      if (!changes_with_time(*model.forces[f])) continue;
      for (const int marker : model.forces[f]->markers()) {
        for (int component = 0; component < 3; ++component) list_.push_back({f, marker, component});
      }
    }
  }

  const std::vector<TimedForce>& list() const { return list_; }

  std::vector<ForcingJump> find_jumps(const TimedForce& timed) {
    std::vector<double> breaks;
    for (const TimeFunction* f : vehicle_.model().forces[timed.force]->time_functions()) {
      breaks.insert(breaks.end(), f->breaks().begin(), f->breaks().end());
    }
    std::sort(breaks.begin(), breaks.end());
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    std::vector<ForcingJump> jumps;
    for (const double at : breaks) {
      const double just_before = std::nextafter(at, -std::numeric_limits<double>::infinity());
      jumps.push_back({at, value(timed, at) - value(timed, just_before)});
    }
    return jumps;
  }

  // The longest step that passes over no detail of the force [s].
  double find_resolution(const TimedForce& timed) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const TimeFunction* f : vehicle_.model().forces[timed.force]->time_functions()) {
      shortest = std::min(shortest, f->details().shortest());
    }
    return shortest;
  }

  // Its value at a time, with the vehicle at rest at its equilibrium.
  double value(const TimedForce& timed, double time) {
    const Model& model = vehicle_.model();
    const ForceElement& force = *model.forces[timed.force];
    for (const int marker : force.markers()) wrenches_[static_cast<std::size_t>(marker)] = {};
    Instant instant = vehicle_.equations().terms().instant_of(static_cast<std::size_t>(timed.force));
    instant.time = time;
    force.add_wrenches(instant, model.branches_of(timed.force, vehicle_.branches()), wrenches_);
    const Wrench& wrench = wrenches_[static_cast<std::size_t>(timed.marker)];
    return timed.component == 2 ? wrench.torque : wrench.force[timed.component];
  }

 private:
  const LinearVehicle& vehicle_;
  std::vector<TimedForce> list_;
  std::vector<Wrench> wrenches_;
};

}  // namespace

double ForcingSpectrum::frequency(Eigen::Index line) const {
  return static_cast<double>(line + 1) / period;
}

ForcingSpectrum calc_forcing_spectrum(const LinearVehicle& vehicle, const KnownForcing& forcing,
                                      double settling, double highest, double fineness) {
  if (!(forcing.duration > 0.0) || !(forcing.speed >= 0.0) || !(settling >= 0.0) || !(highest > 0.0) ||
      !(fineness >= 2.0)) {
    throw std::invalid_argument(
        fmt::format("calc_forcing_spectrum: needs duration > 0 s, speed >= 0 m/s, settling >= 0 s, highest "
                    "> 0 Hz, fineness >= 2; got {}, {}, {}, {}, {}",
                    forcing.duration, forcing.speed, settling, highest, fineness));
  }
  ForcingSpectrum spectrum;
  spectrum.period = forcing.duration + settling;
  const double wanted = std::min(2.0 * fineness * highest * spectrum.period, kMostSamples);
  const auto n = static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(std::ceil(wanted)) + 16));
  // The highest frequency may be that of a line, whose number must not depend on rounding.
  const double last_line = std::ceil((1.0 - 1e-9) * highest * spectrum.period);
  const auto m = std::min(static_cast<Eigen::Index>(last_line), n / 4);

  spectrum.road = Eigen::VectorXcd::Zero(m);
  if (forcing.road != nullptr && forcing.speed > 0.0) {
    const auto height = [&](double t) { return forcing.road->height(forcing.speed * t); };
    spectrum.road = calc_lines(sample(height, forcing.duration, spectrum.period, n), m);
  }
  TimedForces timed(vehicle, forcing);
  std::vector<Eigen::VectorXd> gains;
  std::vector<Eigen::RowVectorXcd> applied;
  for (const TimedForce& one : timed.list()) {
    const double start = timed.value(one, 0.0);
    const auto change = [&](double t) { return timed.value(one, t) - start; };
    // Enough samples for what is faster than the highest line, which would else seem to be slow.
    const double needed = std::min(spectrum.period / timed.find_resolution(one), kMostSamples);
    const auto fine = static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(std::ceil(needed))));
    std::vector<double> samples = sample(change, forcing.duration, spectrum.period, std::max(n, fine));
    smooth_jumps(timed.find_jumps(one), forcing.duration, spectrum.period, samples);
    if (std::all_of(samples.begin(), samples.end(), [](double value) { return value == 0.0; })) continue;
    gains.emplace_back(
        calc_marker_jacobian(vehicle.equations().terms(), one.marker).row(one.component).transpose());
    applied.emplace_back(calc_lines(samples, m).transpose());
    spectrum.loads.push_back(3 * one.marker + one.component);
  }
  const auto u = static_cast<Eigen::Index>(gains.size());
  spectrum.gains.resize(vehicle.model().num_coordinates, u);
  spectrum.applied.resize(u, m);
  for (Eigen::Index i = 0; i < u; ++i) {
    spectrum.gains.col(i) = gains[static_cast<std::size_t>(i)];
    spectrum.applied.row(i) = applied[static_cast<std::size_t>(i)];
  }
  return spectrum;
}

double calc_settling_time(const LinearVehicle& vehicle, double longest) {
  const Eigen::VectorXcd eigenvalues = vehicle.solver().eigenvalues();
  const double rounding = calc_eigenvalue_rounding(eigenvalues);
  double slowest = eigenvalues.cwiseAbs().maxCoeff();
  for (const std::complex<double>& s : eigenvalues) {
    if (std::abs(s) <= rounding) continue;  // a free mode
    slowest = std::min(slowest, std::max(-s.real(), 0.0));
  }
  return slowest > 0.0 ? std::min(-std::log(kRest) / slowest, longest) : longest;
}

double calc_forcing_duration(const LinearVehicle& vehicle, const KnownForcing& forcing, double settling) {
  if (!TimedForces(vehicle, forcing).list().empty()) return forcing.duration;
  const Road* road = forcing.road;
  const double shortest = kShortest * forcing.duration;
  if (road == nullptr || !(forcing.speed > 0.0) || vehicle.inputs().empty()) return shortest;
  const int last = road->num_segments() - 1;
  const double end = last > 0 ? road->segment_end(last - 1) : 0.0;
  if (std::isfinite(road->resolution(last, end))) return forcing.duration;
  double nearest = vehicle.inputs().front().distance, farthest = nearest;
  for (const RoadInput& input : vehicle.inputs()) {
    nearest = std::min(nearest, input.distance);
    farthest = std::max(farthest, input.distance);
  }
  double duration = (std::max(end, 0.0) + farthest - nearest) / forcing.speed;
  if (road->height(end) != road->height(0.0)) duration += settling;
  return std::clamp(duration, shortest, forcing.duration);
}

Eigen::VectorXcd calc_lines(const std::vector<double>& samples, Eigen::Index m) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> lines;
  fft.fwd(lines, samples);
  const Eigen::Map<const Eigen::VectorXcd> all(lines.data(), static_cast<Eigen::Index>(lines.size()));
  return all.segment(1, m) / static_cast<double>(samples.size());
}

Eigen::VectorXd calc_history(const Eigen::Ref<const Eigen::RowVectorXcd>& lines, Eigen::Index n) {
  return calc_histories(lines, Eigen::RowVectorXcd::Zero(lines.size()), n).real();
}

Eigen::VectorXcd calc_histories(const Eigen::Ref<const Eigen::RowVectorXcd>& lines,
                                const Eigen::Ref<const Eigen::RowVectorXcd>& others, Eigen::Index n) {
  const Eigen::Index m = lines.size();
  if (n <= 2 * m || others.size() != m) {
    throw std::invalid_argument(
        fmt::format("calc_history: {} times are too few for {} lines", n, std::max(m, others.size())));
  }
  static Eigen::FFT<double> fft;  // keeps the roots of unity
  std::vector<std::complex<double>> series(static_cast<std::size_t>(n), 0.0), values;
  const std::complex<double> i(0.0, 1.0);
  for (Eigen::Index k = 0; k < m; ++k) {
    const std::complex<double> other = i * others[k], mirrored = i * std::conj(others[k]);
    series[static_cast<std::size_t>(k + 1)] = lines[k] + other;
    series[static_cast<std::size_t>(n - k - 1)] = std::conj(lines[k]) + mirrored;
  }
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  fft.inv(values, series);
  const Eigen::Map<const Eigen::VectorXcd> history(values.data(), n);
  return (history.array() - history[0]).matrix();
}

}  // namespace sprung::dynamics

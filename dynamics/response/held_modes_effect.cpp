#include "dynamics/response/held_modes_effect.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "dynamics/response/harmonic_sweep.h"

namespace sprung::dynamics {

namespace {

// Three of them lie within the width of a resonance with half a per cent of critical damping, where they
// reach over three decades.
constexpr Eigen::Index kFrequencies = 2000;
constexpr double kSmall = 1e-3;  // of the largest output in the same unit

// A road wave of 1 m at each frequency.
struct Waves {
  Eigen::VectorXd omega;    // m [rad/s]
  Eigen::MatrixXcd forces;  // on the independent coordinates, f×m
  Eigen::MatrixXcd direct;  // effect on the outputs, p×m
};

Waves make_waves(const LinearVehicle& vehicle, const LinearOutputs& outputs, double speed,
                 const FrequencyRange& range) {
  Waves waves{.omega = Eigen::VectorXd(kFrequencies),
              .forces = Eigen::MatrixXcd(vehicle.system().mass.rows(), kFrequencies),
              .direct = Eigen::MatrixXcd(outputs.size(), kFrequencies)};
  const Eigen::MatrixXd reduced = vehicle.system().directions.transpose();
  for (Eigen::Index i = 0; i < kFrequencies; ++i) {
    const double f =
        range.from * std::pow(range.to / range.from, static_cast<double>(i) / (kFrequencies - 1));
    const RoadWave wave = make_road_wave(f, speed);
    const RoadAction action = vehicle.calc_road_action(wave);
    const Eigen::VectorXcd delays = vehicle.calc_delays(wave);
    const Eigen::VectorXcd forces = action.forces * delays, channels = action.channels * delays;
    waves.omega[i] = wave.frequency;
    waves.forces.col(i) = reduced * forces;
    waves.direct.col(i) = outputs.by_force * forces;
    for (int k = 0; k < outputs.size(); ++k) {
      const int channel = outputs.channels[static_cast<std::size_t>(k)];
      if (channel >= 0) waves.direct(k, i) += channels[channel];
    }
  }
  return waves;
}

// Square roots of the integrals of |y|² G d ln f.
Eigen::VectorXd calc_sizes(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                           const std::vector<int>& held, const Waves& waves, const Eigen::VectorXd& weights) {
  const HarmonicSweep sweep(make_held_system(vehicle, outputs, held));
  const Eigen::MatrixXd squares = (sweep.respond(waves.omega, waves.forces) + waves.direct).cwiseAbs2();
  return (squares * weights).cwiseSqrt();
}

}  // namespace

Eigen::VectorXd calc_effect_of_holding(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const std::vector<int>& coordinates, const RoadSpectrum* road,
                                       double speed, const FrequencyRange& range) {
  const Waves waves = make_waves(vehicle, outputs, speed, range);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(kFrequencies);
  weights[0] = weights[kFrequencies - 1] = 0.5;
  if (road != nullptr) {
    for (Eigen::Index i = 0; i < kFrequencies; ++i) {
      const double n = waves.omega[i] / (2.0 * std::numbers::pi * speed);
      weights[i] *= n * road->density(n);  // f S_z
    }
  }
  const Eigen::VectorXd with_all = calc_sizes(vehicle, outputs, {}, waves, weights),
                        with_held = calc_sizes(vehicle, outputs, coordinates, waves, weights);
  std::map<std::string, double> largest;
  for (int k = 0; k < outputs.size(); ++k) {
    double& one = largest[outputs.units[static_cast<std::size_t>(k)]];
    one = std::max(one, with_all[k]);
  }
  Eigen::VectorXd change(outputs.size());
  for (int k = 0; k < outputs.size(); ++k) {
    const double size = std::max(with_all[k], kSmall * largest[outputs.units[static_cast<std::size_t>(k)]]);
    change[k] = size > 0.0 ? (with_held[k] - with_all[k]) / size : 0.0;
  }
  return change;
}

}  // namespace sprung::dynamics

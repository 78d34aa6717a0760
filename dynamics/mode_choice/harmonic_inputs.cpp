#include "dynamics/mode_choice/harmonic_inputs.h"

#include <utility>

namespace sprung::dynamics {

HarmonicInputs::HarmonicInputs(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                               const ForcingSpectrum& spectrum, double speed)
    : vehicle_(&vehicle), speed_(speed) {
  const Eigen::MatrixXd by_coordinates = vehicle.system().directions.transpose();
  applied_ = by_coordinates * spectrum.gains;
  applied_direct_ = outputs.by_force * spectrum.gains + outputs.by_load(Eigen::all, spectrum.loads);
  if (!(speed > 0.0)) return;
  for (std::size_t i = 0; i < vehicle.inputs().size(); ++i) {
    const RoadInput& input = vehicle.inputs()[i];
    if (!input.is_pressed) continue;
    wheels_.push_back(i);
    motions_.emplace_back();
    reactions_.emplace_back();
    channels_.emplace_back();
    const auto force = static_cast<std::size_t>(input.force);
    for (const int marker : vehicle.model().forces[force]->markers()) {
      const Eigen::MatrixXd jacobian = calc_marker_jacobian(vehicle.equations().terms(), marker).transpose();
      motions_.back().push_back(by_coordinates * jacobian);
      reactions_.back().push_back(outputs.by_force * jacobian + outputs.by_load.middleCols(3 * marker, 3));
    }
    for (std::size_t row = 0; row < outputs.channels.size(); ++row) {
      const int channel = outputs.channels[row];
      if (channel < vehicle.channel_rows()[force] || channel >= vehicle.channel_rows()[force + 1]) continue;
      channels_.back().emplace_back(static_cast<Eigen::Index>(row), channel - vehicle.channel_rows()[force]);
    }
  }
  num_wheels_ = static_cast<Eigen::Index>(wheels_.size());
}

void HarmonicInputs::calc_gains(double frequency, Gains& gains) const {
  gains.forces.setZero(applied_.rows(), size());
  gains.direct.setZero(applied_direct_.rows(), size());
  gains.forces.rightCols(applied_.cols()) = applied_.cast<std::complex<double>>();
  gains.direct.rightCols(applied_.cols()) = applied_direct_.cast<std::complex<double>>();
  if (num_wheels_ == 0) return;
  const RoadWave wave = make_road_wave(frequency, speed_);
  std::vector<WrenchGain> wrenches(vehicle_->model().markers.size());
  Eigen::VectorXcd channels;
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    const auto column = static_cast<Eigen::Index>(w);
    vehicle_->calc_road_wrenches(wheels_[w], wave, wrenches, channels);
    const auto force = static_cast<std::size_t>(vehicle_->inputs()[wheels_[w]].force);
    const auto markers = vehicle_->model().forces[force]->markers();
    for (std::size_t m = 0; m < motions_[w].size(); ++m) {
      const WrenchGain& wrench = wrenches[static_cast<std::size_t>(markers[m])];
      const std::complex<double> parts[] = {wrench.force.x(), wrench.force.y(), wrench.torque};
      for (Eigen::Index c = 0; c < 3; ++c) {
        if (parts[c] == 0.0) continue;
        gains.forces.col(column) += parts[c] * motions_[w][m].col(c);
        gains.direct.col(column) += parts[c] * reactions_[w][m].col(c);
      }
    }
    for (const auto& [row, channel] : channels_[w]) gains.direct(row, column) += channels[channel];
  }
}

Eigen::VectorXcd HarmonicInputs::calc_wave(double frequency) const {
  Eigen::VectorXcd wave = Eigen::VectorXcd::Zero(size());
  if (num_wheels_ == 0) return wave;
  const Eigen::VectorXcd delays = vehicle_->calc_delays(make_road_wave(frequency, speed_));
  for (std::size_t w = 0; w < wheels_.size(); ++w) {
    wave[static_cast<Eigen::Index>(w)] = delays[static_cast<Eigen::Index>(wheels_[w])];
  }
  return wave;
}

Eigen::MatrixXcd HarmonicInputs::calc_amplitudes(const ForcingSpectrum& spectrum) const {
  Eigen::MatrixXcd amplitudes(size(), spectrum.num_lines());
  for (Eigen::Index line = 0; line < spectrum.num_lines(); ++line) {
    amplitudes.col(line) = spectrum.road[line] * calc_wave(spectrum.frequency(line));
  }
  amplitudes.bottomRows(applied_.cols()) = spectrum.applied;
  return amplitudes;
}

}  // namespace sprung::dynamics

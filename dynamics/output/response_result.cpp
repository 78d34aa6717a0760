#include "dynamics/output/response_result.h"

#include "dynamics/response/random_response.h"

namespace sprung::dynamics {

ResponseResult calc_response_result(const Run& run, const Vehicle& vehicle, const LinearVehicle& linear,
                                    const LinearOutputs& outputs) {
  ResponseResult result{.run = run,
                        .vehicle = vehicle,
                        .overrides = {},
                        .warnings = {},
                        .remarks = {},
                        .inputs = linear.inputs(),
                        .names = outputs.names,
                        .units = outputs.units,
                        .subjects = outputs.subjects,
                        .frequency_hz = list_frequencies(run.response),
                        .response = {},
                        .transfer = {},
                        .spectrum = {},
                        .road_spectrum = {},
                        .rms = {}};
  const auto m = static_cast<Eigen::Index>(result.frequency_hz.size());
  result.response.resize(outputs.size(), m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const RoadWave wave = make_road_wave(result.frequency_hz[static_cast<std::size_t>(i)], run.speed);
    result.transfer.push_back(calc_transfer(linear, outputs, wave));
    result.response.col(i) = result.transfer.back() * linear.calc_delays(wave);
  }
  if (!run.response.road) return result;
  result.road_spectrum.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const double n = result.frequency_hz[static_cast<std::size_t>(i)] / run.speed;
    result.road_spectrum[i] = run.response.road->density(n) / run.speed;
  }
  result.spectrum = result.response.cwiseAbs2() * result.road_spectrum.asDiagonal();
  const FrequencyRange range{.from = run.response.from, .to = run.response.to};
  result.rms = calc_root_mean_squares(linear, outputs, *run.response.road, run.speed, range);
  result.road_rms = calc_road_rms(*run.response.road, run.speed, range);
  return result;
}

}  // namespace sprung::dynamics

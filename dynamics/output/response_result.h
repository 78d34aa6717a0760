#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/input/run.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/response/linear_outputs.h"
#include "dynamics/statistics/run_warnings.h"

namespace sprung::dynamics {

/// Frequency response of a vehicle and, for a random road, spectra and root mean squares: p outputs, m
/// frequencies, k inputs.
struct ResponseResult {
  const Run& run;
  const Vehicle& vehicle;
  std::vector<std::string> overrides;  ///< assignments of the command line, as given
  std::vector<RunWarning> warnings;    ///< of inputs without effect, and of what is not linear
  std::vector<std::string> remarks;    ///< how force laws were linearised
  std::vector<RoadInput> inputs;
  std::vector<std::string> names, units;   ///< p, of the outputs
  std::vector<OutputSubject> subjects;     ///< p
  std::vector<double> frequency_hz;        ///< m
  Eigen::MatrixXcd response;               ///< p×m, of the vehicle on a wave of 1 m
  std::vector<Eigen::MatrixXcd> transfer;  ///< m matrices p×k, from each input alone
  Eigen::MatrixXd spectrum;                ///< p×m [unit²/Hz]; empty without a road
  Eigen::VectorXd road_spectrum;           ///< m [m²/Hz]
  Eigen::VectorXd rms;                     ///< p, over the range of the frequencies
  double road_rms = 0.0;                   ///< of the height, likewise [m]

  bool has_road() const { return rms.size() > 0; }
};

/// Computes the outputs at the frequencies of run.response and, if it has a road spectrum, their spectra and
/// root mean squares.
/// @param run  its speed must be > 0
/// @throws support::NumericalError as calc_root_mean_squares
/// Checked by tests/verification/response_test.py
ResponseResult calc_response_result(const Run& run, const Vehicle& vehicle, const LinearVehicle& linear,
                                    const LinearOutputs& outputs);

}  // namespace sprung::dynamics

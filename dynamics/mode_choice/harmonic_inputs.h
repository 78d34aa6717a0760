#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/mode_choice/forcing_spectrum.h"
#include "dynamics/response/linear_outputs.h"

namespace sprung::dynamics {

/// The inputs of a linear vehicle: the road under each wheel on the ground, then each force that varies with
/// time; i inputs, p outputs, f independent coordinates (mode_choice, eq. 2).
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
class HarmonicInputs {
 public:
  /// @param vehicle, outputs  must outlive this
  /// @param spectrum          whose forces in time are inputs
  /// @param speed             ≥ 0 [m/s]; at 0 the road is no input
  HarmonicInputs(const LinearVehicle& vehicle, const LinearOutputs& outputs, const ForcingSpectrum& spectrum,
                 double speed);

  Eigen::Index size() const { return num_wheels_ + applied_.cols(); }

  /// Effect of a unit of each input at one frequency [Hz].
  struct Gains {
    Eigen::MatrixXcd forces;  ///< f×i, on the independent coordinates
    Eigen::MatrixXcd direct;  ///< p×i, direct effect on the outputs
  };
  void calc_gains(double frequency, Gains& gains) const;
  /// Amplitudes of the inputs on a road wave of 1 m under the foremost wheel, i: phases of the wheels, 0 for
  /// forces in time.
  Eigen::VectorXcd calc_wave(double frequency) const;
  /// Amplitude of each input in each of the spectrum's lines, i×m.
  Eigen::MatrixXcd calc_amplitudes(const ForcingSpectrum& spectrum) const;

 private:
  const LinearVehicle* vehicle_;
  double speed_;
  Eigen::Index num_wheels_ = 0;
  std::vector<std::size_t> wheels_;                                // indices into vehicle_->inputs()
  std::vector<std::vector<Eigen::MatrixXd>> motions_, reactions_;  // for each wheel's markers: f×3, p×3
  std::vector<std::vector<std::pair<Eigen::Index, Eigen::Index>>>
      channels_;                              // for each wheel: output, its channel
  Eigen::MatrixXd applied_, applied_direct_;  // f×, p×(forces in time)
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/response/linear_vehicle.h"
#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// The part of a run's forcing that is known beforehand.
struct KnownForcing {
  const Road* road = nullptr;  ///< s = 0 under the foremost wheel at the start
  double speed = 0.0;          ///< ≥ 0 [m/s]; at 0 the road has no effect
  double duration = 0.0;       ///< of the run, > 0 [s]
  bool is_road_alone = false;  ///< forces that vary with time do not act, as in a response
};

/// The forcing as a Fourier series over a period, z(t) = Σ z_k e^{iω_k t} with ω_k = 2πk/period: the road
/// under the foremost wheel, and the change from the start of u forces that vary with time (mode_choice, eq.
/// 1). Lines k = 1 … m are in columns k − 1.
struct ForcingSpectrum {
  double period = 0.0;       ///< [s]
  Eigen::VectorXcd road;     ///< m [m]
  Eigen::MatrixXd gains;     ///< nq×u, generalized forces per unit of each of the u forces
  std::vector<int> loads;    ///< u, each of the forces as a column of LinearOutputs::by_load
  Eigen::MatrixXcd applied;  ///< u×m

  Eigen::Index num_lines() const { return road.size(); }
  double frequency(Eigen::Index line) const;  ///< of column `line` [Hz]
};

/// Fourier coefficients of the forcing during the run, followed by a time in which the vehicle comes to rest.
/// The forcing fades out over the first half of that time, and the period is both times together. Forces that
/// do not change are left out.
/// @param settling  time to come to rest, ≥ 0 [s]
/// @param highest   frequency of the lines, > 0 [Hz]
/// @param fineness  number of samples, of the least number that the highest line needs, ≥ 2
/// @throws std::invalid_argument for values outside these ranges
/// Checked by tests/dynamics/mode_choice/forcing_spectrum_test.cpp
ForcingSpectrum calc_forcing_spectrum(const LinearVehicle& vehicle, const KnownForcing& forcing,
                                      double settling, double highest, double fineness = 8.0);

/// Time after which the road is level under all wheels, at most the duration of the run [s]. With forces in
/// time it is the duration of the run.
/// @param settling  added where the road ends at another height than it begins
/// Checked by tests/dynamics/mode_choice/forcing_spectrum_test.cpp
double calc_forcing_duration(const LinearVehicle& vehicle, const KnownForcing& forcing, double settling);

/// Time in which the slowest of the damped motions about the equilibrium decays to a hundredth, at most
/// `longest` [s].
double calc_settling_time(const LinearVehicle& vehicle, double longest);

/// Fourier coefficients of lines 1 … m of a function with these values over its period.
/// @param samples  n > 2m
Eigen::VectorXcd calc_lines(const std::vector<double>& samples, Eigen::Index m);

/// Values of a Fourier series over its period, relative to the value at the start.
/// @param lines  coefficients of lines 1 … m
/// @param n      number of times, a power of two > 2m
/// @return n
/// @throws std::invalid_argument if n is too small
/// Checked by tests/dynamics/mode_choice/forcing_spectrum_test.cpp
Eigen::VectorXd calc_history(const Eigen::Ref<const Eigen::RowVectorXcd>& lines, Eigen::Index n);
/// Values of two series by one transform: the first as real, the second as imaginary part.
Eigen::VectorXcd calc_histories(const Eigen::Ref<const Eigen::RowVectorXcd>& lines,
                                const Eigen::Ref<const Eigen::RowVectorXcd>& others, Eigen::Index n);

}  // namespace sprung::dynamics

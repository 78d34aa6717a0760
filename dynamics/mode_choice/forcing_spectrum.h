#pragma once

#include <Eigen/Core>

#include "dynamics/linear/linear_vehicle.h"
#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// What a run does to its vehicle, as far as it is known beforehand.
struct KnownForcing {
  const Road* road = nullptr;  ///< s = 0 under the foremost wheel at the start
  double speed = 0.0;          ///< ≥ 0 [m/s]; at 0 the road does nothing
  double duration = 0.0;       ///< of the run, > 0 [s]
};

/// The forcing as a Fourier series over a period: road under the foremost wheel, and u forces that change
/// with time, each less its value at the start: what z(t) = Σ z_k e^{iω_k t}, ω_k = 2πk/period, is made of.
/// Lines k = 1 … m; column k − 1 (mode_choice, eq. 1).
struct ForcingSpectrum {
  double period = 0.0;       ///< [s]
  Eigen::VectorXcd road;     ///< m [m]
  Eigen::MatrixXd gains;     ///< nq×u, generalized forces by the u forces
  Eigen::MatrixXcd applied;  ///< u×m

  Eigen::Index num_lines() const { return road.size(); }
  double frequency(Eigen::Index line) const;  ///< of column `line` [Hz]
};

/// Samples the forcing during the run and lets it fade over the first half of the time that the vehicle needs
/// to come to rest, the period being both together; sampled eight times as finely as the highest line needs,
/// or as chosen. Forces that do not change are left out.
/// @param settling  time to come to rest, ≥ 0 [s]  @param highest  of the lines, > 0 [Hz]  @param fineness  ≥
/// 2
/// @throws std::invalid_argument
ForcingSpectrum calc_forcing_spectrum(const LinearVehicle& vehicle, const KnownForcing& forcing,
                                      double settling, double highest, double fineness = 8.0);

/// Time from which on nothing changes any more under any wheel, at most the run's [s].
/// @param settling  added where the road goes on at another height than it began
double calc_forcing_duration(const LinearVehicle& vehicle, const KnownForcing& forcing, double settling);

/// Time in which the slowest of the damped motions about the equilibrium falls to a hundredth, at most
/// `longest` [s].
double calc_settling_time(const LinearVehicle& vehicle, double longest);

/// Values over the period of a series with these lines and without mean, at n times [n a power of two > 2m]:
/// from its own value at the start.
Eigen::VectorXd calc_history(const Eigen::Ref<const Eigen::RowVectorXcd>& lines, Eigen::Index n);
/// Of two series by one transform: one as real, the other as imaginary part.
Eigen::VectorXcd calc_histories(const Eigen::Ref<const Eigen::RowVectorXcd>& lines,
                                const Eigen::Ref<const Eigen::RowVectorXcd>& others, Eigen::Index n);

}  // namespace sprung::dynamics

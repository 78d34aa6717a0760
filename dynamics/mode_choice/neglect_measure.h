#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/mode_choice/forcing_spectrum.h"
#include "dynamics/mode_choice/harmonic_inputs.h"
#include "dynamics/mode_choice/held_response.h"
#include "dynamics/mode_choice/nonlinear_forces.h"
#include "dynamics/mode_choice/quantity_sizes.h"
#include "dynamics/mode_choice/watched_quantities.h"

namespace sprung::dynamics {

/// The effect of holding a set of modes, as shares of w watched quantities (mode_choice, eq. 4).
struct NeglectedShares {
  Eigen::VectorXd rms;   ///< w, of the r.m.s. over the run and the time until the vehicle is at rest
  Eigen::VectorXd peak;  ///< w, of the largest value
  /// w, under the weight alone: of the largest value or, if that is larger, of the largest effect of all
  /// modes on a quantity of the same kind.
  Eigen::VectorXd weight;

  struct Worst {
    double value = 0.0;
    std::size_t quantity = 0;
    const char* measure = "r.m.s.";  ///< "peak", "static"
  };
  Worst worst() const;
};

/// Computes the effect of holding sets of modes of a linear vehicle under a known forcing.
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
class NeglectMeasure {
 public:
  /// @param vehicle, watched  must outlive this
  /// @param coordinates       the n modal coordinates in question, as positions in q
  /// @param cut               share of each quantity's r.m.s. that may lie above the highest line, > 0
  NeglectMeasure(const LinearVehicle& vehicle, const WatchedQuantities& watched, std::vector<int> coordinates,
                 const KnownForcing& forcing, double cut);

  /// Shares of one set, computed at every line.
  /// @param set  positions among the n modes
  NeglectedShares measure(const std::vector<int>& set) const;
  /// Shares of each of many small sets, accurate to a few hundredths. Peaks are computed for the quantity of
  /// each kind with the largest r.m.s. share; those of all others are 0.
  std::vector<NeglectedShares> measure_alone(const std::vector<std::vector<int>>& sets) const;

  /// Shares of what one set would add to the motion under the forces of elements beyond their linear laws
  /// (mode_choice, eq. 7). All are 0 without such forces.
  /// @param set  positions among the n modes
  NeglectedShares measure_beyond_linear(const std::vector<int>& set, const NonlinearForces& forces) const;
  NonlinearForces calc_nonlinear_forces() const;  ///< up to the highest frequencies of the vehicle

  /// The lowest value of an output of the vehicle with all modes, relative to the equilibrium.
  double find_lowest(int row) const;
  /// Watched outputs on a road wave of 1 m under the foremost wheel, at k lines.
  /// @return p×k
  RowsXcd calc_wave_response(const std::vector<Eigen::Index>& lines) const;

  const ForcingSpectrum& forcing() const { return forcing_; }
  Eigen::Index num_lines() const { return omega_.size(); }
  /// Share of the r.m.s. that lies above the lines, for the quantity with the largest one.
  double share_above() const { return share_above_; }
  /// Whether the forcing moves the vehicle.
  bool is_excited() const { return is_excited_; }
  /// Whether share_above() is larger than allowed.
  bool is_cut_short() const { return is_cut_short_; }

 private:
  double find_highest_frequency(const KnownForcing& forcing, double settling, double cut);
  void calc_references();
  HeldResponse calc_static_response() const;
  std::vector<int> find_coordinates(const std::vector<int>& set) const;
  Eigen::VectorXd calc_static_shares(const std::vector<int>& set) const;

  const LinearVehicle* vehicle_;
  const WatchedQuantities* watched_;
  std::vector<int> coordinates_;
  double speed_;
  HarmonicSweep sweep_;
  ForcingSpectrum forcing_;
  std::optional<HarmonicInputs> inputs_;  // made after forcing_
  double share_above_ = 0.0;
  bool is_cut_short_ = false, is_excited_ = false;
  HeldResponse at_rest_;
  Eigen::VectorXd omega_;                // m
  Eigen::MatrixXcd amplitudes_;          // of the inputs, i×m
  Eigen::MatrixXcd forces_;              // on the independent coordinates, f×m
  RowsXcd outputs_, whole_;              // p×m, without and with the direct effect of the road
  Eigen::VectorXd rms_, peak_, weight_;  // w, sizes that shares refer to; infinite: not judged
};

}  // namespace sprung::dynamics

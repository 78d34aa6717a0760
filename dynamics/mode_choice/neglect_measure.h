#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/mode_choice/forcing_spectrum.h"
#include "dynamics/mode_choice/harmonic_inputs.h"
#include "dynamics/mode_choice/held_response.h"
#include "dynamics/mode_choice/quantity_sizes.h"
#include "dynamics/mode_choice/watched_quantities.h"

namespace sprung::dynamics {

/// What holding a set of modes still changes, as shares of w watched quantities (mode_choice, eq. 4).
struct NeglectedShares {
  Eigen::VectorXd rms;   ///< w, of each one's r.m.s. over the run and the vehicle's coming to rest
  Eigen::VectorXd peak;  ///< w, of its largest value
  /// w, under the weight alone: of its largest value, or of what all modes do to the quantity of its kind
  /// that they change most.
  Eigen::VectorXd weight;

  struct Worst {
    double value = 0.0;
    std::size_t quantity = 0;
    const char* measure = "r.m.s.";  ///< "peak", "static"
  };
  Worst worst() const;
};

/// Measures what sets of modes are worth to a linear vehicle under a forcing that is known beforehand.
class NeglectMeasure {
 public:
  /// @param coordinates  the n modal coordinates in question
  /// @param cut          share of each quantity's r.m.s. that may lie above the highest frequency looked at,
  /// > 0
  /// @param vehicle, watched  have to outlive this
  NeglectMeasure(const LinearVehicle& vehicle, const WatchedQuantities& watched, std::vector<int> coordinates,
                 const KnownForcing& forcing, double cut);

  /// Of one set of positions among the modes, at every line.
  NeglectedShares measure(const std::vector<int>& set) const;
  /// Of many small sets, to a few hundredths of each share; the peak of the quantity of each kind with the
  /// largest share of r.m.s., 0 of all others.
  std::vector<NeglectedShares> measure_alone(const std::vector<std::vector<int>>& sets) const;

  /// The lowest value of an output of the vehicle with all modes, counted from where it stands.
  double find_lowest(int row) const;
  /// Watched outputs on a wave of the road of 1 m under the foremost wheel.  @param lines  k  @return p×k
  RowsXcd calc_wave_response(const std::vector<Eigen::Index>& lines) const;

  const ForcingSpectrum& forcing() const { return forcing_; }
  Eigen::Index num_lines() const { return omega_.size(); }
  /// What lies above the lines, of the r.m.s. of the quantity that has most of it there.
  double share_above() const { return share_above_; }
  bool is_excited() const { return rms_.size() > 0 && rms_.maxCoeff() > 0.0; }  ///< moves at all
  bool is_cut_short() const { return is_cut_short_; }  ///< more than what was allowed

 private:
  double find_highest_frequency(const KnownForcing& forcing, double settling, double cut);
  void calc_references();
  HeldResponse calc_static_response() const;
  Eigen::VectorXd calc_static_shares(const std::vector<int>& set) const;

  const LinearVehicle* vehicle_;
  const WatchedQuantities* watched_;
  std::vector<int> coordinates_;
  double speed_;
  HarmonicSweep sweep_;
  ForcingSpectrum forcing_;
  std::optional<HarmonicInputs> inputs_;  // once the forces are known
  double share_above_ = 0.0;
  bool is_cut_short_ = false;
  HeldResponse at_rest_;
  Eigen::VectorXd omega_;                // m
  Eigen::MatrixXcd amplitudes_;          // of the inputs, i×m
  Eigen::MatrixXcd forces_;              // on the independent coordinates, f×m
  RowsXcd outputs_, whole_;              // p×m, of the motion alone, and with what the road does directly
  Eigen::VectorXd rms_, peak_, weight_;  // w, what shares are of
};

}  // namespace sprung::dynamics

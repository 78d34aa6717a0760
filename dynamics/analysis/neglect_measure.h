#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/analysis/forcing_spectrum.h"
#include "dynamics/analysis/held_response.h"
#include "dynamics/analysis/watched_quantities.h"

namespace sprung::dynamics {

/// What holding a set of modes still changes, as shares of w watched quantities (dynamics/README.md, eq. 85).
struct NeglectedShares {
  Eigen::VectorXd rms;     ///< w, of each one's r.m.s. over the run and the vehicle's coming to rest
  Eigen::VectorXd peak;    ///< w, of its largest value
  Eigen::VectorXd weight;  ///< w, under the weight alone, of its largest value or of what all modes do there

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
  /// @param coordinates  the n modal coordinates in question  @param balance  q of the equilibrium
  /// @param accuracy     share of each quantity's r.m.s. that may lie above the highest frequency looked at, > 0
  /// @param vehicle, watched  have to outlive this
  NeglectMeasure(const LinearVehicle& vehicle, const WatchedQuantities& watched, std::vector<int> coordinates,
                 const KnownForcing& forcing, double accuracy);

  /// @param sets  of positions among the modes
  std::vector<NeglectedShares> measure(const std::vector<std::vector<int>>& sets) const;
  /// The same for the sets of the first sizes[0], sizes[1], … modes of an order of all.
  std::vector<NeglectedShares> measure_nested(const std::vector<int>& order, const std::vector<int>& sizes) const;

  const ForcingSpectrum& forcing() const { return forcing_; }
  Eigen::Index num_lines() const { return num_lines_; }  ///< those looked at, the lowest
  bool is_cut_short() const { return share_above_ > 0.0; }  ///< what lies above them is more than the accuracy
  /// What lies above them then, of the r.m.s. of the quantity that has most of it there.
  double share_above() const { return share_above_; }

 private:
  // Changes of the outputs by sets of modes, p×sets.
  using Changes = std::function<Eigen::MatrixXcd(const HeldResponse&)>;
  struct Action {
    Eigen::VectorXcd force, channels;
  };
  struct Sizes {
    Eigen::VectorXd rms, peak;  // w
  };

  Action calc_action(Eigen::Index line) const;
  void choose_num_lines(double accuracy);
  void calc_references();
  HeldResponse calc_static_response() const;
  Sizes calc_sizes(const Eigen::MatrixXcd& lines) const;
  std::vector<NeglectedShares> measure(const Changes& changes, std::size_t num_sets) const;

  const LinearVehicle* vehicle_;
  const WatchedQuantities* watched_;
  std::vector<int> coordinates_;
  double speed_;
  HeldResponseSolver solver_;
  ForcingSpectrum forcing_;
  Eigen::Index num_lines_ = 0;
  double share_above_ = 0.0;  // 0 where it is less than the accuracy
  Eigen::VectorXd rms_, peak_, weight_;  // w, what shares are of
};

}  // namespace sprung::dynamics

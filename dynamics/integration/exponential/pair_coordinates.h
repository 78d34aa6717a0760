#pragma once

#include <Eigen/Core>

#include "dynamics/integration/exponential/collocation_step.h"
#include "dynamics/integration/exponential/inertial_shear.h"
#include "dynamics/integration/exponential/vibration_basis.h"

namespace sprung::dynamics {

/// The coordinates in which the exponential method integrates: uncoupled pairs of small motion in place of
/// positions and velocities (integration/exponential, eqs. 1–2), and the error norm of the state in them.
/// State y = (q, v, w), f freedoms.
class PairCoordinates {
 public:
  PairCoordinates() = default;
  /// @param size  of y
  PairCoordinates(Eigen::Index num_freedoms, Eigen::Index size);

  /// Takes the pairs of another small motion. From now on positions count from those in y, since the pairs of
  /// large positions would have few digits. @param elastic  freedoms that deform bodies
  void update(const SmallMotion& motion, const std::vector<int>& elastic, const Eigen::VectorXd& y);
  /// What makes the pairs follow the inertia of the freedoms that deform no body.
  const InertialShear& shear() const { return shear_; }
  /// The highest angular frequency of the pairs [rad/s].
  double highest_frequency() const { return highest_frequency_; }
  const PairBlocks& blocks() const { return basis_.blocks; }

  /// The shear of a step shall reach at its end what a mass matrix asks for. Its drive at the start and that
  /// of the step before then hold for the new rate of the shear.
  /// @param mass_columns  of the others, at the end; nullptr: the shear stays
  /// @return false where nothing has changed
  bool aim_shear(const Eigen::MatrixXd* mass_columns, CollocationStep& now, CollocationStep& last);

  /// The pairs of the state at the start of a step.
  void to_pairs(const Eigen::VectorXd& y, const CollocationStep& step, PairedMotion& motion);
  /// The state that a motion of a step is, t seconds after its start.
  void to_state(const PairedMotion& motion, const CollocationStep& step, double t, Eigen::VectorXd& y) const;
  /// What a small change of the pairs then changes in positions and velocities, and back.
  /// @param u, change  2f
  void to_state_change(const Eigen::VectorXd& u, const CollocationStep& step, double t,
                       Eigen::VectorXd& change) const;
  void to_pair_change(Eigen::VectorXd& change, const CollocationStep& step, double t,
                      Eigen::VectorXd& u) const;  ///< overwrites `change`
  /// The drive at a node of a step: the part of the derivatives ẏ that the pairs do not explain.
  /// @param motion  that of the state y
  void calc_drive(const Eigen::VectorXd& y, const Eigen::VectorXd& y_dot, const PairedMotion& motion,
                  int node, CollocationStep& step);

  /// The error allowed in each component of y is `tolerance` times its entry of `sizes`, > 0.
  void set_allowed_error(double tolerance, const Eigen::VectorXd& sizes) {
    inverse_allowed_ = (tolerance * sizes).cwiseInverse();
  }
  /// Root mean square over the components of y, each divided by the error allowed in it.
  double calc_norm(const PairedMotion& difference, const CollocationStep& step);
  /// An estimate of calc_norm from the pairs alone, with the errors allowed at the last `update`.
  template <class Pairs>
  double estimate_norm(const Pairs& difference) const {
    return pair_sizes_.cwiseProduct(difference).norm();
  }

 private:
  Eigen::Index f_ = 0;
  VibrationBasis basis_;
  InertialShear shear_;
  Eigen::VectorXd origin_;              // f positions
  Eigen::VectorXd inverse_allowed_;     // of y
  Eigen::VectorXd pair_sizes_;          // 2f: what one of each pair adds to calc_norm
  Eigen::VectorXd work_;                // of y
  Eigen::VectorXd derivatives_;         // of y
  Eigen::MatrixXd rate_, rate_change_;  // of the shear, others × elastic
  double highest_frequency_ = 0.0;
};

}  // namespace sprung::dynamics

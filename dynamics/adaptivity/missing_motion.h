#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/adaptivity/full_small_motion.h"
#include "dynamics/adaptivity/step_responses.h"

namespace sprung::dynamics {

/// What the modes left out would add to the motion of a run, together and to first order: small motion of the
/// full model under the forces that the run leaves unbalanced on them, in its f undamped vibrations
/// (adaptivity, eq. 7).
/// Checked by tests/verification/left_out_test.py
class MissingMotion {
 public:
  /// @param motion  of the full model about the start of the run; only read here
  explicit MissingMotion(const FullSmallMotion& motion);

  /// Continues through a step in which the forces change linearly, or to the same instant where they have
  /// jumped.
  /// @param step    at least 0; the first call begins in balance with the forces [s]
  /// @param forces  unbalanced ones on each mode, 0 for active ones [N/√kg]
  void update(double step, const Eigen::VectorXd& forces);
  /// Added acceleration of each point asked for, along x and y in turn [m/s²].
  const Eigen::VectorXd& accelerations() const { return accelerations_; }

  template <class Bytes, class Motion>
  static void transfer(Bytes& bytes, Motion& motion) {
    bytes.transfer(motion.has_begun_);
    bytes.transfer_items(motion.vibrations_, [&](auto& one) {
      bytes.transfer(one.place);
      bytes.transfer(one.rate);
      bytes.transfer(one.force);
    });
  }
  std::size_t num_vibrations() const { return vibrations_.size(); }

 private:
  struct Vibration {
    double place = 0.0, rate = 0.0, force = 0.0;  // amplitude, its rate, and the force at the last update
  };
  void add_vibrations(const FullSmallMotion& motion);
  void add_lone_modes(const FullSmallMotion& motion);

  std::vector<Vibration> vibrations_;
  StepResponses responses_;
  double neutral_ = 0.0;                  // ω² up to which a motion counts as neutral
  Eigen::MatrixXd of_modes_, of_points_;  // motion of the modes and of the points per unit of each vibration
  bool has_begun_ = false;
  Eigen::VectorXd driving_, vibration_accelerations_, accelerations_;
};

}  // namespace sprung::dynamics

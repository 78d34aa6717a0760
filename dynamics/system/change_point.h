#pragma once

#include <Eigen/Core>
#include <span>

#include "dynamics/system/constrained_equations.h"
#include "dynamics/system/partition.h"

namespace sprung::dynamics {

/// One step over a change point: a position at which the constraints of a mechanism become dependent, and
/// from which it can go on in more than one way. In all coordinates, so that no choice of independent ones
/// matters; on the branch that the velocities point to (system, eq. 11). nq coordinates.
class ChangePointStep {
 public:
  /// One end of the step.
  struct End {
    double time = 0.0;                                ///< [s]
    Eigen::VectorXd q, v, v_dot;                      ///< nq
    Eigen::VectorXd lambda;                           ///< m
    Eigen::Vector2d power = Eigen::Vector2d::Zero();  ///< dissipated and put in [W]
  };

  /// @param model  has to outlive this
  explicit ChangePointStep(const Model& model);

  /// Steps from where the equations stand, accelerations included, to the first place tried at which the
  /// determinant of φ_d is as large again; where a change point lies just behind, to the first at which the
  /// smallest pivot of φ_q is much larger. @param longest  step [s]
  /// @return false where there is none, or where the joints do not close near the motion continued
  bool pass(const ConstrainedEquations& from, const Partition& partition, std::span<const int> branches,
            double longest);
  const End& begin() const { return begin_; }
  const End& end() const { return end_; }
  /// Forces on modes that come from the run, see SystemTerms.
  SystemTerms& terms() { return equations_.terms(); }
  bool contains(double time) const { return begin_.time <= time && time < end_.time; }
  /// Energy dissipated and put in from the beginning to `time` [J].
  Eigen::Vector2d calc_work(double time) const;
  /// Motion within the step, where the equations have no unique multipliers.
  void interpolate(double time, End& at) const;

 private:
  bool close(double time, std::span<const int> branches);
  bool correct(double time, std::span<const int> branches);

  const Model* model_;
  ConstrainedEquations equations_;
  End begin_, end_;
  Eigen::VectorXd q_, v_;  // predicted or corrected, before joints are closed
};

}  // namespace sprung::dynamics

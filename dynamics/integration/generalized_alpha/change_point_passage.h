#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "dynamics/system/change_point.h"
#include "dynamics/system/index3_residual.h"

namespace sprung::dynamics {

/// The change points of a run: how near the motion is to one, and the step over it (system, "Change points").
class ChangePointPassage {
 public:
  /// @param model  has to outlive this
  explicit ChangePointPassage(const Model& model) : model_(&model) {}

  /// As if newly made, at the positions where a run starts.
  void start(SystemTerms& terms, const ConstrainedMotion& motion);
  /// Looks at the pivots of φ_q at these positions.
  void update_pivot(SystemTerms& terms, const ConstrainedMotion& motion);
  /// Smallest pivot of φ_q, of the largest that it had when it was looked at or has usually; 1 where it is
  /// not small.
  double pivot() const { return pivot_; }
  /// Whether the motion has come so near to a change point that it is passed in a step of its own.
  bool is_near() const { return is_near_; }

  /// Makes that step. @param from  where it begins, with accelerations
  /// @param longest  step [s]   @param energy  dissipated and put in until there [J]
  /// @return false where there is no such step
  bool pass(const ConstrainedEquations& from, std::span<const int> branches, double longest,
            const Eigen::Vector2d& energy);
  /// Forgets the step over a change point.
  void leave() { has_passed_ = false; }
  bool contains(double time) const { return has_passed_ && step_->contains(time); }
  const ChangePointStep::End& begin() const { return step_->begin(); }
  const ChangePointStep::End& end() const { return step_->end(); }
  /// Motion within the step. @return energy dissipated and put in until there [J]
  Eigen::Vector2d interpolate(double time, ChangePointStep::End& at) const;

 private:
  const Model* model_;
  double pivot_ = 1.0, best_pivot_ = 0.0;
  std::optional<double> usual_pivot_;  // found where a pivot is small
  bool is_near_ = false, has_passed_ = false;
  std::optional<ChangePointStep> step_;  // made at the first change point
  Eigen::Vector2d energy_before_ = Eigen::Vector2d::Zero();
};

}  // namespace sprung::dynamics

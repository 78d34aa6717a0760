#include "dynamics/integration/generalized_alpha/change_point_passage.h"

#include <algorithm>

#include "dynamics/system/partition.h"

namespace sprung::dynamics {

namespace {

constexpr double kSmallPivot = 0.1;  // of the largest: rounding grows noticeably below it
constexpr double kNearPivot = 1e-3;  // likewise: a step of its own is as accurate as the others below it

}  // namespace

void ChangePointPassage::start(SystemTerms& terms, const ConstrainedMotion& motion) {
  best_pivot_ = 0.0;
  has_passed_ = false;
  update_pivot(terms, motion);
}

void ChangePointPassage::update_pivot(SystemTerms& terms, const ConstrainedMotion& motion) {
  terms.update_positions(motion.time, motion.q);
  terms.update_jacobian();
  terms.update_mass();
  const double before = pivot_, found = choose_partition(terms).smallest_pivot;
  if (found < kSmallPivot && !usual_pivot_) usual_pivot_ = calc_usual_pivot(*model_, motion.time, motion.q);
  best_pivot_ = std::max({best_pivot_, found, usual_pivot_.value_or(0.0)});
  pivot_ = found < kSmallPivot * best_pivot_ ? found / best_pivot_ : 1.0;
  is_near_ = pivot_ < kNearPivot && pivot_ < before;
}

bool ChangePointPassage::pass(const ConstrainedEquations& from, std::span<const int> branches, double longest,
                              const Eigen::Vector2d& energy) {
  if (!step_) step_.emplace(*model_);
  step_->terms().set_fading_forces(from.terms().fading_forces());
  has_passed_ = step_->pass(from, choose_partition(from.terms()), branches, longest);
  energy_before_ = energy;
  return has_passed_;
}

Eigen::Vector2d ChangePointPassage::interpolate(double time, ChangePointStep::End& at) const {
  step_->interpolate(time, at);
  return energy_before_ + step_->calc_work(time);
}

}  // namespace sprung::dynamics

#include "dynamics/integration/smooth_piece.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace sprung::dynamics {

SmoothPiece::SmoothPiece(const Model& model)
    : model_(&model), branches_(static_cast<std::size_t>(model.num_branches)) {
  for (const auto& force : model.forces) num_switches_ += force->num_switches();
}

std::vector<BranchChange> SmoothPiece::update_branches(const SystemTerms& terms) {
  const std::vector<int> old_branches = branches_;
  terms.choose_branches(branches_);
  std::vector<BranchChange> changes;
  for (std::size_t i = 0; i < model_->forces.size(); ++i) {
    const ForceElement& force = *model_->forces[i];
    const std::string text =
        force.describe_change(model_->branches_of(i, old_branches), model_->branches_of(i, branches_));
    if (!text.empty()) changes.push_back({force.name, text});
  }
  return changes;
}

void SmoothPiece::calc_switches(const SystemTerms& terms, std::span<double> values) const {
  std::size_t next = 0;
  for (std::size_t i = 0; i < model_->forces.size(); ++i) {
    const ForceElement& force = *model_->forces[i];
    const auto count = static_cast<std::size_t>(force.num_switches());
    force.calc_switches(terms.instant_of(i), model_->branches_of(i, branches_), values.subspan(next, count));
    next += count;
  }
}

double SmoothPiece::calc_longest_step(const SystemTerms& terms, double time) const {
  double longest = model_->time_details.calc_longest_step(time);
  for (std::size_t f = 0; f < model_->forces.size(); ++f)
    longest = std::min(longest, model_->forces[f]->calc_longest_step(terms.instant_of(f)));
  if (model_->has_moving_joints) {
    for (const auto& joint : model_->joints) {
      longest = std::min(longest, joint->calc_longest_step(time, model_->length_scale));
    }
  }
  return longest;
}

double SmoothPiece::update_next_break(double time) {
  constexpr double kShortest = 1e-9;  // s
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<double>& breaks = model_->time_breaks;
  const auto next = std::upper_bound(breaks.begin(), breaks.end(), time,
                                     [](double after, double one) { return one - after >= kShortest; });
  earliest_time_ = next == breaks.begin() ? -kInfinity : *std::prev(next);
  if (next == breaks.end()) return latest_time_ = kInfinity;
  latest_time_ = std::nextafter(*next, -kInfinity);
  return *next;
}

}  // namespace sprung::dynamics

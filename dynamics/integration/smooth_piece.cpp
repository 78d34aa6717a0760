#include "dynamics/integration/smooth_piece.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr std::size_t kMaxPhases = 5;

}  // namespace

SmoothPiece::SmoothPiece(const Model& model)
    : model_(&model),
      phases_(kMaxPhases, {.branches = std::vector<int>(static_cast<std::size_t>(model.num_branches))}) {
  for (std::size_t i = 0; i < model.forces.size(); ++i) {
    for (int k = 0; k < model.forces[i]->num_switches(); ++k) switches_.push_back({i, k});
  }
}

void SmoothPiece::set_branches(const std::vector<int>& branches) {
  take_back_passes();
  phases_[0].branches = branches;
}

std::vector<BranchChange> SmoothPiece::update_branches(const SystemTerms& terms) {
  const std::vector<int> old_branches = branches();
  set_branches(old_branches);
  terms.choose_branches(phases_[0].branches);
  std::vector<BranchChange> changes;
  for (std::size_t i = 0; i < model_->forces.size(); ++i) {
    const ForceElement& force = *model_->forces[i];
    const std::string text = force.describe_change(own_branches(i, old_branches), branches_of(i));
    if (!text.empty()) changes.push_back({force.name, text});
  }
  return changes;
}

void SmoothPiece::calc_switches(const SystemTerms& terms, std::span<double> values) const {
  std::size_t next = 0;
  for (std::size_t i = 0; i < model_->forces.size(); ++i) {
    const ForceElement& force = *model_->forces[i];
    const auto count = static_cast<std::size_t>(force.num_switches());
    force.calc_switches(terms.instant(), branches_of(i), values.subspan(next, count));
    next += count;
  }
}

Passage SmoothPiece::passage(int switch_index) const {
  const Switch& one = switches_[static_cast<std::size_t>(switch_index)];
  return model_->forces[one.force]->passage(one.index, branches_of(one.force));
}

std::optional<SmoothPiece::Pass> SmoothPiece::pass(int switch_index, double time) {
  const auto [force, index] = switches_[static_cast<std::size_t>(switch_index)];
  for (std::size_t k = 1; k < num_phases_; ++k) {
    if (phases_[k].passed_force == force) return {};
  }
  if (num_phases_ == kMaxPhases) return {};
  Phase& last = phases_[num_phases_ - 1];
  Phase& next = phases_[num_phases_];
  last.end = time;
  next.branches = last.branches;
  next.passed_force = force;
  model_->forces[force]->go_beyond(index, own_branches(force, next.branches));
  now_ = num_phases_++;
  return Pass{force, own_branches(force, std::as_const(last.branches)), branches_of(force)};
}

void SmoothPiece::go_to(double time) {
  now_ = 0;
  while (now_ + 1 < num_phases_ && time >= phases_[now_].end) ++now_;
}

void SmoothPiece::begin_step() {
  std::swap(phases_[0].branches, phases_[num_phases_ - 1].branches);
  take_back_passes();
}

double SmoothPiece::calc_longest_step(const SystemTerms& terms) const {
  const Instant now = terms.instant();
  double longest = model_->time_resolution;
  for (const auto& force : model_->forces) longest = std::min(longest, force->calc_longest_step(now));
  if (model_->has_motions) {
    for (const auto& joint : model_->joints) {
      longest = std::min(longest, joint->calc_longest_step(now.time, model_->length_scale));
    }
  }
  return longest;
}

double SmoothPiece::update_next_break(double time) {
  constexpr double kShortest = 1e-9;  // s
  const auto next = std::upper_bound(model_->time_breaks.begin(), model_->time_breaks.end(), time,
                                     [](double after, double one) { return one - after >= kShortest; });
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (next == model_->time_breaks.end()) return latest_time_ = kInfinity;
  latest_time_ = std::nextafter(*next, -kInfinity);
  return *next;
}

}  // namespace sprung::dynamics

#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// A force element that went over to another of its formulas.
struct BranchChange {
  std::string element;  ///< its name
  std::string text;     ///< "touches the ground"
};

/// What makes the equations smooth for a while: the formulas in use, up to the next zero of a switch
/// function, and the pieces of functions of time, up to their next break.
class SmoothPiece {
 public:
  /// @param model has to outlive this
  explicit SmoothPiece(const Model& model);

  const std::vector<int>& branches() const { return phases_[now_].branches; }
  void set_branches(const std::vector<int>& branches);
  /// Chooses the branches that hold at the state of the terms. @return the changes worth telling
  std::vector<BranchChange> update_branches(const SystemTerms& terms);

  int num_switches() const { return static_cast<int>(switches_.size()); }
  /// @param terms  positions and velocities up to date   @param[out] values  num_switches
  void calc_switches(const SystemTerms& terms, std::span<double> values) const;
  /// What happens at the zero of a switch function.
  Passage passage(int switch_index) const;
  /// A force element and its branches before and behind the zero of one of its switch functions.
  struct Pass {
    std::size_t force;
    std::span<const int> from, to;
  };
  /// From `time` on, the element of a switch uses the branches next to the present ones; branches() are
  /// those. Called in order of time. @return none, and nothing changed, where it has done so since
  /// begin_step, or too many have
  std::optional<Pass> pass(int switch_index, double time);
  void take_back_passes() { num_phases_ = 1, now_ = 0; }
  /// branches() become those of a time since begin_step.
  void go_to(double time);
  /// Only the branches that were passed to last count from now on.
  void begin_step();
  /// Longest step that no force element and no prescribed motion would regret, at the state of the terms [s].
  double calc_longest_step(const SystemTerms& terms) const;

  /// The next break in time of a function of time after `time`, infinite where there is none; pieces too
  /// short to be integrated are passed over. From now on that is where the piece ends.
  double update_next_break(double time);
  /// The time to evaluate at for `time`: at the break itself a hair before it, so that the formula that ends
  /// there is used up to its end.
  double evaluation_time(double time) const { return std::min(time, latest_time_); }

 private:
  struct Phase {
    std::vector<int> branches;
    double end = std::numeric_limits<double>::infinity();  // s
    std::size_t passed_force = 0;                          // at its start
  };
  template <class Branches>
  auto own_branches(std::size_t force, Branches& branches) const {
    return std::span(branches).subspan(static_cast<std::size_t>(model_->force_branches[force]),
                                       static_cast<std::size_t>(model_->forces[force]->num_branches()));
  }
  std::span<const int> branches_of(std::size_t force) const {
    return own_branches(force, phases_[now_].branches);
  }

  const Model* model_;
  std::vector<Phase> phases_;  // since begin_step, in order of time: the first num_phases_ of them
  std::size_t num_phases_ = 1, now_ = 0;
  struct Switch {
    std::size_t force;
    int index;  // among the force's own
  };
  std::vector<Switch> switches_;
  double latest_time_ = std::numeric_limits<double>::infinity();  // just before the next break
};

}  // namespace sprung::dynamics

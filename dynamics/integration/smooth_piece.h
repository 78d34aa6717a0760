#pragma once

#include <algorithm>
#include <limits>
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

  const std::vector<int>& branches() const { return branches_; }
  void set_branches(const std::vector<int>& branches) { branches_ = branches; }
  /// Chooses the branches that hold at the state of the terms. @return the changes worth telling
  std::vector<BranchChange> update_branches(const SystemTerms& terms);

  int num_switches() const { return num_switches_; }
  /// @param terms  positions and velocities up to date   @param[out] values  num_switches
  void calc_switches(const SystemTerms& terms, std::span<double> values) const;
  /// Longest step that no force element and no prescribed motion would regret, at the state of the terms [s].
  double calc_longest_step(const SystemTerms& terms) const;

  /// The next break in time of a function of time after `time`, infinite where there is none; pieces too
  /// short to be integrated are passed over. From now on that is where the piece ends.
  double update_next_break(double time);
  /// The time to evaluate at for `time`: at the break itself a hair before it, so that the formula that ends
  /// there is used up to its end.
  double evaluation_time(double time) const { return std::min(time, latest_time_); }

 private:
  const Model* model_;
  std::vector<int> branches_;
  int num_switches_ = 0;
  double latest_time_ = std::numeric_limits<double>::infinity();  // just before the next break
};

}  // namespace sprung::dynamics

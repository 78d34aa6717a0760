#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// A force element that now uses another of its formulas.
struct BranchChange {
  std::string element;  ///< its name
  std::string text;     ///< "touches the ground"
};

/// A stretch of time in which the equations are smooth: it ends at the next zero of a switch function, where
/// the formula of a force element changes, or at the next break of a function of time.
class SmoothPiece {
 public:
  /// @param model has to outlive this
  explicit SmoothPiece(const Model& model);

  const std::vector<int>& branches() const { return branches_; }
  void set_branches(const std::vector<int>& branches) { branches_ = branches; }
  /// Chooses the branches that hold at the state of the terms. @return the changes that are worth an event
  std::vector<BranchChange> update_branches(const SystemTerms& terms);

  int num_switches() const { return num_switches_; }
  /// @param terms  positions and velocities up to date   @param[out] values  num_switches
  void calc_switches(const SystemTerms& terms, std::span<double> values) const;
  /// Longest step that passes over nothing that force elements and functions of time know to come.
  /// @param terms  of a state at `time` or shortly before   @param time  where the step begins [s]
  /// @return [s]
  double calc_longest_step(const SystemTerms& terms, double time) const;

  /// Makes the piece end at the next break of a function of time after `time`. Pieces too short to be
  /// integrated are passed over.
  /// @return that break, infinite where there is none [s]
  double update_next_break(double time);
  /// The time at which formulas are evaluated for `time`: the same, but at the break itself the number before
  /// it, so that the formula that ends there is used up to its end. Where breaks were passed over, it is not
  /// before them: the formula after them is used from the start of the piece.
  double evaluation_time(double time) const { return std::clamp(time, earliest_time_, latest_time_); }

 private:
  const Model* model_;
  std::vector<int> branches_;
  int num_switches_ = 0;
  double earliest_time_ = -std::numeric_limits<double>::infinity();  // the last break
  double latest_time_ = std::numeric_limits<double>::infinity();     // just before the next break
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/analysis/mode_adaptation.h"
#include "dynamics/system/constrained_equations.h"
#include "dynamics/system/held_modes.h"

namespace sprung::dynamics {

/// The models that a run with changing modes goes through, and what is carried over from one to the next. Positions and
/// velocities in coordinates of the full model are kept beside those of the model that is stepped.
/// Source: dynamics/README.md, eqs. 71, 75 and 76.
class ModeChanges {
 public:
  /// @param model  that the run was given: the full one where modes change
  ModeChanges(const Model& model, const AdaptivityOptions& options, const State& start);

  bool can_change() const { return modes_.options().changes; }
  const Model& stepped_model() const { return can_change() ? held_.model : *model_; }
  const ModeAdaptation& adaptation() const { return modes_; }

  /// The present state for the stepped model.
  State stepped_state(double time, const std::vector<int>& branches) const;

  /// Takes over what the stepped model is at.
  void take(const ConstrainedEquations& equations);
  /// Takes it over and brings the indicator there.
  void update(double time, const ConstrainedEquations& equations, std::span<const int> branches);
  double rate(int coordinate) const { return v_[coordinate]; }

  /// The terms of the full model at what was taken last, for output; forces are not up to date.
  const SystemTerms& calc_full_terms(double time);
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }
  const Eigen::VectorXd& v_dot() const { return v_dot_; }

  struct Memory;
  std::shared_ptr<const Memory> remember() const;

  /// Goes back to an instant and makes modes join there: they start from where they are held, at rest, and the force
  /// that held them is let go over a few periods.
  void join(const Memory& memory, double time, const std::vector<int>& coordinates);
  /// Stops modes for good at what was taken last: the others keep their momentum. @return energy lost by it [J]
  double leave(double time, const std::vector<int>& coordinates, std::span<const int> branches);

 private:
  void hold(double time);

  const Model* model_;
  ModeAdaptation modes_;
  HeldModes held_;
  std::optional<SystemTerms> full_terms_;
  std::vector<FadingForce> fading_;  // `mode` is a coordinate of the full model
  Eigen::VectorXd q_, v_, v_dot_;
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "dynamics/integration/exponential/lobatto_step.h"
#include "dynamics/integration/ode_system.h"
#include "dynamics/integration/switch_search.h"

namespace sprung::dynamics {

/// Motion at one instant, taken apart by a VibrationBasis; or its derivative.
struct PairedMotion {
  Eigen::VectorXd u;  ///< pairs, 2f
  Eigen::VectorXd w;  ///< quadratures

  void set_zero() { u.setZero(), w.setZero(); }
};

/// Within a step a force goes over to another formula, without a jump: what the drive gains from there on.
struct Bend {
  int switch_index = 0;
  int power_order = 1;         ///< of the shape, with which the rates of quadratures go
  double place = 0.0;          ///< θ
  lobatto::NodeWeights shape;  ///< of the gain at the nodes of the step: the cubic through them is 0 at the
                               ///< place, 1 at the end
  PairedMotion gain;           ///< at the end

  /// Adds what the gain does from the place to θ. @param propagator  for use within
  void add_response(double theta, double length, const PairBlocks& blocks, LobattoPropagator& propagator,
                    PairedMotion& motion) const;
  /// Adds the gain at θ, as though the formula had held all along.
  void add_gain(double theta, PairedMotion& drive) const;
  /// What the power's course is not known better than, at the end, if it goes with the first power of the
  /// shape [rate · s].
  double calc_doubt(double length) const;
};

/// The bends of one step.
class Bends {
 public:
  Bends() = default;
  Bends(Eigen::Index num_pairs, Eigen::Index num_quadratures);

  /// Those that the switch functions tell, in order of time, their gains unknown.
  /// @param switches  num_switches × 4, at the nodes
  /// @return false, and none, where something else than a few bends happens
  bool find(const OdeSystem& system, const Eigen::MatrixXd& switches, SwitchSearch& search);
  /// One more from the place of the first on: a gain that grows with the square of the time, as a motion does
  /// which the others cause. Not to be called twice.
  Bend& add_echo();
  void clear() { size_ = 0; }

  std::span<Bend> all() { return {bends_.data(), size_}; }
  std::span<const Bend> all() const { return {bends_.data(), size_}; }

 private:
  static constexpr std::size_t kMaxBends = 4;
  std::array<Bend, kMaxBends + 1> bends_;
  std::size_t size_ = 0;
};

}  // namespace sprung::dynamics

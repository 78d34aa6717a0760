#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/adaptivity/full_small_motion.h"

namespace sprung::dynamics {

/// Each mode of a full model as an oscillator, to which everything else that is active gives way: what is
/// stiffer than the mode by its stiffness, what is softer by its inertia (adaptivity, eq. 2).
class EffectiveModes {
 public:
  struct Mode {
    double mass = 0.0, damping = 0.0, stiffness = 0.0;
    double deflection = 0.0;         ///< largest of a named point, per unit of the mode [m/(m·√kg)]
    std::vector<double> reach = {};  ///< displacement of each point asked for, per unit of the mode
  };

  /// @param motion  has to outlive this   @param is_active  of each mode
  EffectiveModes(const FullSmallMotion& motion, const std::vector<bool>& is_active);
  /// Takes another set of active modes.
  void update(const std::vector<bool>& is_active);
  const Mode& operator[](std::size_t mode) const { return modes_[mode]; }
  double calc_frequency(std::size_t mode) const;  ///< [Hz]

 private:
  Eigen::MatrixXd calc_directions(const std::vector<bool>& is_active) const;
  Mode make_lone_mode(int coordinate) const;

  const FullSmallMotion* motion_;
  std::vector<Mode> modes_;
  std::vector<Eigen::Index> own_;  // places of the modes among the independent coordinates
  std::vector<double> own_rates_;  // ω² of each mode by itself [1/s²]
};

}  // namespace sprung::dynamics

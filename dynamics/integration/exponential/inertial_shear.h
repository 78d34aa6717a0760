#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/integration/exponential/vibration_basis.h"

namespace sprung::dynamics {

/// How the freedoms that deform no body give way to fast vibration of the elastic ones, by inertia alone:
/// δq_o = G δq_e with the least kinetic energy. G changes as bodies turn, and what it has become since the
/// pairs were made is added to the motion that they describe (integration/exponential, eq. 6). Checked by
/// tests/dynamics/integration/exponential/inertial_shear_test.cpp
class InertialShear {
 public:
  /// Begins with pairs that were made for a mass matrix: they need no shear.
  /// @param elastic  freedoms, ascending, may be empty   @param mass  M̂, f×f
  void start(const VibrationBasis& basis, const std::vector<int>& elastic, const Eigen::MatrixXd& mass);
  /// Whether there are both elastic freedoms and others.
  bool is_useful() const { return !elastic_.empty() && !others_.empty(); }
  const std::vector<int>& others() const { return others_; }

  /// Takes the shear to another mass matrix. @param columns  those of M̂ that belong to the others
  /// @return false where these have no inertia: nothing has changed
  bool follow(const Eigen::MatrixXd& columns);
  /// Brings pairs from before the last `follow` to those of the same states after it.
  /// @param[in,out] pairs  2f×n, a state in each column
  void convert(Eigen::MatrixXd& pairs);

  /// From the state T u to that of the sheared pairs, and back. @param[in,out] state  2f: positions,
  /// velocities
  void add(double* state) const { shift(1.0, state); }
  void remove(double* state) const { shift(-1.0, state); }

 private:
  bool calc_ratio(const Eigen::MatrixXd& columns);
  void shift(double factor, double* state) const;

  Eigen::Index f_ = 0;
  bool has_inertia_ = false;  // the others, where the pairs were made
  std::vector<int> elastic_, others_;
  // −G of the pairs; ΔG, and its last change: others × elastic.
  Eigen::MatrixXd first_ratio_, shear_, change_;
  Eigen::MatrixXd factor_, ratio_;                          // M̂_oo, M̂_oo⁻¹ M̂_oe
  Eigen::MatrixXd elastic_positions_, elastic_velocities_;  // transposed rows of T, 2f × elastic
  Eigen::MatrixXd change_rows_;    // ΔG's last change times these rows of T, for positions and velocities
  Eigen::MatrixXd other_columns_;  // of T⁻¹, likewise
  mutable Eigen::VectorXd elastic_motion_, other_motion_;  // work space
  Eigen::VectorXd loss_;
};

}  // namespace sprung::dynamics

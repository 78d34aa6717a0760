#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/system/block_jacobian.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The constraints of all joints, by the motion of their markers: φ, φ_q, φ_t and γ (system, eq. 1), in
/// preallocated storage. m constraints, nq coordinates.
class SystemConstraints {
 public:
  /// @param model    has to outlive this
  /// @param markers  their states at any positions: where a joint's Jacobian by its markers is constant, it
  ///                 is found here once and for all
  SystemConstraints(const Model& model, std::span<const MarkerState> markers);

  /// @param[out] phi  m [m, rad]
  void calc_residual(std::span<const MarkerState> markers, double time,
                     Eigen::Ref<Eigen::VectorXd> phi) const;
  /// Brings the values of `jacobian()` up to date with the markers' positions.
  void update_jacobian(std::span<const MarkerState> markers);
  const BlockJacobian& jacobian() const { return Phi_q_; }  ///< φ_q, m×nq; its pattern is always right
  /// @param[out] phi_t  m [m/s, rad/s]
  void calc_time_rate(std::span<const MarkerState> markers, double time,
                      Eigen::Ref<Eigen::VectorXd> phi_t) const;
  /// After update_jacobian. @param[out] gamma  m, right-hand side of φ_q q̈ = γ [m/s², rad/s²]
  void calc_gamma(std::span<const MarkerState> markers, double time, Eigen::Ref<Eigen::VectorXd> gamma) const;
  /// Adds the forces of the joints on each marker, after update_jacobian.
  /// @param lambda  m multipliers   @param loads  of all markers, world axes
  void add_joint_loads(const Eigen::VectorXd& lambda, std::span<Wrench> loads) const;

 private:
  // A joint's Jacobian by one of its markers, and the block of φ_q that is made of it.
  struct JointSide {
    std::size_t marker;
    JointJacobian G;
    std::ptrdiff_t block;  // −1 for a marker on the ground
  };
  struct JointTerms {
    const Joint* joint;
    int row, num_rows;
    bool is_constant, drifts;  // its Jacobian; whether φ̈ has terms without accelerations
    JointSide a, b;
  };
  // Where a joint's Jacobian by its markers is constant, only these values in its row on a body change: the
  // one of the angle and those of the modes.
  struct TurningRow {
    std::size_t value;  // the first of them in φ_q
    std::size_t marker;
    MarkerRow G;
  };
  void add_joint(std::size_t joint, std::span<const MarkerState> markers);
  void add_block(const JointTerms& terms, JointSide& side);
  void fill_constant_joint(const JointTerms& terms, std::span<const MarkerState> markers);
  static void fill_turning(const MarkerRow& G, const MarkerState& state, double* values);
  static void fill_modal(const MarkerRow& G, const MarkerState& state, double* values);
  void fill_block(const JointSide& side, const MarkerState& state);

  const Model* model_;
  std::vector<JointTerms> joints_;
  std::vector<TurningRow> turning_rows_;
  std::vector<std::size_t> varying_joints_;  // whose G depends on the position: their blocks are filled anew
  BlockJacobian Phi_q_;
};

}  // namespace sprung::dynamics

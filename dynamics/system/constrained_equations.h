#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/system/multiplier_solver.h"
#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// Solves M q̈ + φ_qᵀλ = Q, φ_q q̈ = γ at given positions and velocities of all coordinates, as every method of
/// integration does in the end (system, eqs. 1, 6, 7, 12; bodies, eq. 6). nq coordinates, m constraints.
/// Allocates nothing once made.
class ConstrainedEquations {
 public:
  ConstrainedEquations(const Model& model, SystemTerms::Markers scope);

  SystemTerms& terms() { return terms_; }
  const SystemTerms& terms() const { return terms_; }
  const Eigen::VectorXd& q() const { return terms_.q(); }
  const Eigen::VectorXd& v() const { return terms_.v(); }
  const Eigen::VectorXd& v_dot() const { return v_dot_; }
  const Eigen::VectorXd& multipliers() const { return lambda_; }

  /// Accelerations and multipliers, after positions, Jacobian and velocities of the terms.
  /// @return false where NaN or infinity came out, or constraints have become dependent
  bool update_accelerations(std::span<const int> branches);
  /// Takes accelerations and multipliers from elsewhere, for positions and velocities that close the joints.
  void set_motion(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                  const Eigen::VectorXd& v_dot, const Eigen::VectorXd& lambda, std::span<const int> branches);
  /// Entries of the factor for the multipliers.
  int num_factor_entries() const { return multipliers_.num_factor_entries(); }
  /// Whether `v_dot` and `multipliers` belong to the present time, q and v.
  bool has_accelerations() const { return terms_.has(SystemTerms::Term::kAccelerations); }
  /// Power that prescribed motion puts in, λᵀφ_t, after update_accelerations [W] (joints, eq. 6).
  double calc_motion_power();

  /// Positions and Jacobian where the joints close, moved from q by the least distance in the mass metric.
  /// @return false where they do not close
  bool close_joints(double time, const Eigen::VectorXd& q);
  /// Accelerations that additional forces would cause, after update_accelerations:
  /// M x + φ_qᵀμ = force, φ_q x = 0. @param force, x  nq
  void calc_response(const Eigen::VectorXd& force, Eigen::VectorXd& x);
  /// Velocities nearest to v, in the mass metric, that the joints allow; after close_joints.
  /// @return largest |φ_q v + φ_t| before [m/s, rad/s]; NaN where there is no such velocity
  double close_rates(const Eigen::VectorXd& v);

 private:
  void apply_inverse_mass(Eigen::VectorXd& x) const;
  bool factorise();
  void calc_correction();
  bool solve_by_improvement();
  void improve_accelerations();
  double calc_metric_size(const Eigen::VectorXd& x);

  const Model* model_;
  SystemTerms terms_;
  MultiplierSolver multipliers_;
  Eigen::VectorXd inverse_mass_;             // nq, of bodies whose mass is constant; of the others 1
  std::vector<std::size_t> varying_bodies_;  // those others
  Eigen::VectorXd v_dot_;                    // nq
  Eigen::VectorXd lambda_;                   // m
  Eigen::VectorXd motion_rate_;              // φ_t of prescribed motion, m
  // Work space: what is passed to and comes from calc_correction, and the iterates of the two functions that
  // close joints.
  Eigen::VectorXd violation_, impulse_;                 // m
  Eigen::VectorXd correction_, closing_q_, closing_v_;  // nq
  Eigen::VectorXd change_, momentum_;                   // nq, of a model with massless bodies
};

}  // namespace sprung::dynamics

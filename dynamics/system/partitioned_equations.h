#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/system/constrained_equations.h"
#include "dynamics/system/dependent_solver.h"
#include "dynamics/system/partition.h"
#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// The equations of motion in the independent coordinates (generalized coordinate partitioning): given q_i
/// and v_i, finds q_d, v_d, all accelerations and the multipliers (system, eqs. 4–7). The cost grows with the
/// number of joints and, for each body, with its modes; no allocation in the evaluating functions, but where
/// pivots of φ_d are chosen anew (SparseLu). f freedoms, m constraints, nq coordinates.
/// Source: [Wehage & Haug 1982]
class PartitionedEquations {
 public:
  enum class Outcome {
    kGood,
    kNotAssembled,  ///< the dependent coordinates did not converge, or to another way of assembling the
                    ///< mechanism: too far a step, or near a singular position
    kNotFinite,     ///< NaN or infinity came out
  };

  explicit PartitionedEquations(const Model& model);

  /// Chooses the partition at q, which must satisfy the constraints closely; positions q become the start of
  /// the next search for dependents.
  void choose_partition_at(double time, const Eigen::VectorXd& q);
  const Partition& partition() const { return partition_; }
  /// Marks a motion as one that has really been come to.
  void mark(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  /// The next search for dependents starts at the marked positions, and not where a trial too far away has
  /// ended.
  void return_to_mark();
  /// Whether a dependent angle has turned by half a turn more or less since the mark than its velocities then
  /// and now tell: Newton may find the mechanism assembled, but full turns off. After update_velocities.
  bool has_lost_turns(double time) const;
  int num_freedoms() const { return num_freedoms_; }

  /// Positions: dependents from independents, Jacobian and its factors.
  Outcome update_positions(double time, std::span<const double> q_independent);
  /// Velocities, after update_positions.
  void update_velocities(std::span<const double> v_independent);
  /// Accelerations and multipliers, after update_velocities: M q̈ + φ_qᵀλ = Q.
  Outcome update_accelerations(std::span<const int> branches);

  /// Power that prescribed motion puts in, λᵀφ_t, after update_accelerations [W] (joints, eq. 6).
  double calc_motion_power() { return full_.calc_motion_power(); }

  /// Brings the markers that only results ask for up to date as well.
  void update_all_markers() { mutable_terms().update_all_markers(); }

  /// The equations in all coordinates, at the motion evaluated last.
  const ConstrainedEquations& constrained() const { return full_; }
  const SystemTerms& terms() const { return full_.terms(); }
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }
  const Eigen::VectorXd& v_dot() const { return full_.v_dot(); }
  const Eigen::VectorXd& multipliers() const { return full_.multipliers(); }

  /// D = ∂v/∂v_i, nq×f, what the constraints leave free, at the positions evaluated last.
  Eigen::MatrixXd calc_directions() const;
  /// Dᵀ M D, f×f, after update_accelerations.
  Eigen::MatrixXd calc_reduced_mass(const Eigen::MatrixXd& directions) const;
  /// DᵀM D q̈_i: the force that the independents feel, f, after update_accelerations.
  Eigen::VectorXd calc_reduced_force(const Eigen::MatrixXd& directions) const;

  /// Entries of the factors that an evaluation computes: its work grows with them.
  int num_factor_entries() const { return dependents_.num_factor_entries() + full_.num_factor_entries(); }

  /// How much worse the dependents follow the independents than when the partition was chosen, at least 1.
  double partition_decay() const { return dependents_.decay(); }

 private:
  SystemTerms& mutable_terms() { return full_.terms(); }
  bool solve_dependents(double time);
  void refactor();

  const Model* model_;
  ConstrainedEquations full_;
  Partition partition_;
  DependentSolver dependents_;
  int num_freedoms_, num_constraints_;

  Eigen::VectorXd q_, v_, last_good_q_;
  std::vector<int> dependent_angles_;  // coordinates
  Eigen::VectorXd marked_q_, marked_v_;
  double marked_time_ = 0.0;
  Eigen::VectorXd residual_, correction_;  // m
  std::vector<double> step_;               // of the independents, f
  bool has_accelerations_ = false;         // at q_
};

}  // namespace sprung::dynamics

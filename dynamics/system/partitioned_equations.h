#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "dynamics/system/constrained_equations.h"
#include "dynamics/system/dependent_solver.h"
#include "dynamics/system/partition.h"
#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// The equations of motion in the independent coordinates (generalized coordinate partitioning): given q_i
/// and v_i, finds q_d, v_d, all accelerations and the multipliers (system, eqs. 4–7). The cost grows with the
/// number of joints and, for each body, with its modes. The evaluating functions allocate nothing, unless
/// pivots of φ_d are chosen anew (SparseLu). f freedoms, m constraints, nq coordinates.
///
/// A search for positions can fail: too far a step, or a position near a singular one. The equations then go
/// back to the *accepted motion*, the last one known to be right, and the next search starts there.
/// Source: [Wehage & Haug 1982]
class PartitionedEquations {
 public:
  enum class Outcome {
    kGood,
    kNotAssembled,  ///< the dependent coordinates did not converge, or to another way of assembling the
                    ///< mechanism, or with some bodies full turns off
    kNotFinite,     ///< NaN or infinity came out
  };

  explicit PartitionedEquations(const Model& model);

  /// Chooses the partition at q, which has to satisfy the constraints closely, and accepts q at rest.
  /// @param q  num_coordinates   @throws std::invalid_argument if it has another size
  void choose_partition_at(double time, const Eigen::VectorXd& q);
  const Partition& partition() const { return partition_; }
  int num_freedoms() const { return num_freedoms_; }
  /// Accepts a motion of all coordinates.
  void accept_motion(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  /// Accepts the motion at which the equations stand, if it is complete.
  void accept_motion();

  /// Goes back to the accepted motion, without its velocities.
  void return_to_accepted();

  /// Positions: dependents from independents, Jacobian and its factors. Where it fails, the positions are
  /// those of the accepted motion, without velocities.
  Outcome update_positions(double time, std::span<const double> q_independent);
  /// One more Newton step for the dependent coordinates, after update_positions: the joints are then closed
  /// as exactly as rounding allows. Differences over short distances need it.
  void refine_positions();
  /// Velocities, after update_positions.
  void update_velocities(std::span<const double> v_independent);
  /// Positions and velocities. They are refused, too, where a dependent angle has turned by half a turn more
  /// or less since the accepted motion than its velocities there and here give: the mechanism is assembled,
  /// but full turns off.
  Outcome update_motion(double time, std::span<const double> q_independent,
                        std::span<const double> v_independent);
  /// Whether the equations stand at this motion, velocities included.
  bool is_at(double time, std::span<const double> q_independent, std::span<const double> v_independent) const;
  /// Masses and forces alone, after update_velocities.
  void update_forces(std::span<const int> branches);
  /// Accelerations and multipliers with them: M q̈ + φ_qᵀλ = Q.
  Outcome update_accelerations(std::span<const int> branches);

  /// Power that prescribed motion puts in, λᵀφ_t, after update_accelerations [W] (joints, eq. 6).
  double calc_motion_power() { return full_.calc_motion_power(); }

  /// Brings the markers that only results ask for up to date as well.
  void update_all_markers() { mutable_terms().update_all_markers(); }
  /// Forces on modes that come from the run, see SystemTerms.
  void set_fading_forces(std::vector<FadingForce> fading) {
    mutable_terms().set_fading_forces(std::move(fading));
  }

  /// Linear laws of damper forces, see SystemForces.
  void set_rate_slopes(std::vector<std::vector<double>> slopes) {
    mutable_terms().set_rate_slopes(std::move(slopes));
  }

  /// For positions at which the independents do not give the dependents, see ConstrainedEquations; after it
  /// `return_to_accepted`.
  ConstrainedEquations& all_coordinates() { return full_; }
  /// The equations in all coordinates, at the motion evaluated last.
  const ConstrainedEquations& constrained() const { return full_; }
  const SystemTerms& terms() const { return full_.terms(); }
  const Eigen::VectorXd& q() const { return full_.q(); }
  const Eigen::VectorXd& v() const { return full_.v(); }
  const Eigen::VectorXd& v_dot() const { return full_.v_dot(); }
  const Eigen::VectorXd& multipliers() const { return full_.multipliers(); }

  /// D = ∂v/∂v_i, nq×f, what the constraints leave free, at the positions evaluated last.
  Eigen::MatrixXd calc_directions() const;
  void calc_directions(Eigen::MatrixXd& directions) const;
  /// Pattern of D, nq×f: 1 where an entry differs from zero at some positions, 0 where it never does.
  Eigen::MatrixXd find_pattern_of_directions() const;
  /// Mass matrices at the positions evaluated last; update_accelerations does so, too.
  void update_mass() { mutable_terms().update_mass(); }
  /// Dᵀ M D, f×f, after update_mass.
  Eigen::MatrixXd calc_reduced_mass(const Eigen::MatrixXd& directions) const;
  /// Columns of it, without D. @param freedoms  c of them   @param[out] columns  f×c
  void calc_mass_columns(const std::vector<int>& freedoms, Eigen::MatrixXd& columns) const;
  /// Accelerations that additional forces would cause, see ConstrainedEquations.
  void calc_response(const Eigen::VectorXd& force, Eigen::VectorXd& x) { full_.calc_response(force, x); }
  /// D x_i, nq, without D. @param x_independent  f
  Eigen::VectorXd calc_free_motion(const Eigen::VectorXd& x_independent) const;
  /// Dᵀ x, f, without D: the part of a force that constraints do not take. @param x  nq
  Eigen::VectorXd calc_reduced(const Eigen::VectorXd& x) const;
  /// M x, nq, after update_mass.
  Eigen::VectorXd apply_mass(const Eigen::VectorXd& x) const;

  /// Entries of the factors that an evaluation computes: its work grows with them.
  int num_factor_entries() const { return dependents_.num_factor_entries() + full_.num_factor_entries(); }

  /// How much worse the dependents follow the independents than when the partition was chosen, or than at the
  /// best motion that was marked since, at least 1.
  double partition_decay() const { return dependents_.decay(); }
  /// Marks the present motion, for a partition that was not a good one when it was chosen.
  void mark_if_best() { dependents_.raise_reference(); }

 private:
  SystemTerms& mutable_terms() { return full_.terms(); }
  bool solve_dependents(double time);
  void calc_direction(std::size_t freedom, Eigen::Ref<Eigen::VectorXd> direction) const;
  void apply_mass(const Eigen::VectorXd& x, Eigen::VectorXd& product) const;
  void reduce(const Eigen::VectorXd& x, double* reduced) const;
  bool has_lost_turns() const;
  void refactor();

  const Model* model_;
  ConstrainedEquations full_;
  Partition partition_;
  DependentSolver dependents_;
  int num_freedoms_, num_constraints_;
  double closing_tolerance_ = 0.0;     // of joints
  std::vector<int> dependent_angles_;  // coordinates

  double accepted_time_ = 0.0;
  Eigen::VectorXd accepted_q_, accepted_v_;  // nq
  // Work space.
  Eigen::VectorXd trial_q_, trial_v_;                  // nq
  Eigen::VectorXd residual_, correction_;              // m
  mutable Eigen::VectorXd column_, dependent_column_;  // m
  mutable Eigen::VectorXd direction_, momentum_;       // nq
  std::vector<double> step_;                           // of the independents, f
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <span>
#include <vector>

#include "dynamics/system/partition.h"
#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// The equations of motion in the independent coordinates (generalized coordinate partitioning): given q_i and v_i,
/// finds q_d, v_d, all accelerations and the multipliers (dynamics/README.md, eqs. 15–20). No allocation in the
/// evaluating functions. f freedoms, m constraints.
/// Source: [Wehage & Haug 1982]
class PartitionedEquations {
 public:
  enum class Outcome {
    kGood,
    kNotAssembled,  ///< the dependent coordinates did not converge, or to another way of assembling the mechanism:
                    ///< too far a step, or near a singular position
    kNotFinite,     ///< NaN or infinity came out
  };

  explicit PartitionedEquations(const Model& model);

  /// Chooses the partition at q, which must satisfy the constraints closely; positions q become the start of the
  /// next search for dependents.
  void choose_partition_at(double time, const Eigen::VectorXd& q);
  const Partition& partition() const { return partition_; }
  int num_freedoms() const { return num_freedoms_; }

  /// Positions: dependents from independents, Jacobian and its factors.
  Outcome update_positions(double time, std::span<const double> q_independent);
  /// Velocities, after update_positions.
  void update_velocities(std::span<const double> v_independent);
  /// Accelerations, after update_velocities.
  Outcome update_accelerations(std::span<const int> branches);
  /// Multipliers, after update_accelerations; φ_qᵀλ = Q − M q̈.
  void update_multipliers();

  /// Power that prescribed motion puts in, λᵀφ_t, after update_multipliers [W] (dynamics/README.md, eq. 29).
  double calc_motion_power();

  const SystemTerms& terms() const { return terms_; }
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }
  const Eigen::VectorXd& v_dot() const { return v_dot_; }
  const Eigen::VectorXd& multipliers() const { return lambda_; }
  /// ∂v/∂v_i, nq×f: what the constraints leave free.
  const Eigen::MatrixXd& freedom_directions() const { return directions_; }
  const Eigen::MatrixXd& reduced_mass() const { return M_hat_; }      ///< f×f, after update_accelerations
  const Eigen::VectorXd& reduced_force() const { return Q_hat_; }     ///< f, after update_accelerations

  /// How much worse the dependents follow the independents than when the partition was chosen: the largest entry of
  /// the mass-scaled ∂v_d/∂v_i over its value then (at least 1).
  double partition_decay() const;

 private:
  double scaled_growth() const;
  bool solve_dependents(double time);
  bool is_determinant_negative();
  void factorise();

  const Model* model_;
  SystemTerms terms_;
  Partition partition_;
  int num_freedoms_, num_constraints_;
  double growth_at_choice_ = 1.0;
  bool is_mirrored_ = false;  // sign of det φ_d at the choice of partition
  std::vector<bool> visited_;

  Eigen::VectorXd q_, v_, v_dot_, lambda_;
  Eigen::VectorXd last_good_q_;
  Eigen::VectorXd q_i_, v_i_, a_i_, Q_hat_;               // f
  Eigen::VectorXd q_d_, phi_, correction_, gamma_;        // m
  Eigen::VectorXd alpha_, residual_force_;                // nq
  Eigen::MatrixXd Phi_d_, Phi_i_, T_, directions_, M_hat_, M_directions_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_d_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::VectorXd mass_scale_;  // √M_ii at the choice of partition
};

}  // namespace sprung::dynamics

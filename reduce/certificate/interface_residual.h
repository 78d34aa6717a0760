#pragma once

#include <Eigen/Core>

#include "reduce/modes/eigen_pairs.h"
#include "reduce/modes/stiffness_factor.h"

namespace sprung::reduce {

/// What a basis misses of a free body's response to unit loads: the residual r of each load and its norm
/// D = rᵀK⁻¹r, at any frequency, from products that are made once (reduce/certificate, eqs. 3–5).
///
/// The basis is that of the exact modes given at the beginning, and of vectors that are added. All vectors
/// are those of the held frame, n values each; s is ω² [rad²/s²]. b loads, m vectors.
/// Checked by tests/reduce/certificate/interface_residual_test.cpp
class InterfaceResidual {
 public:
  /// @param problem  of a free frame; it and the factor are kept by reference
  /// @param exact    free modes that the basis holds
  /// @param loads    n×b, balanced (free_body.h)
  InterfaceResidual(const ModalProblem& problem, const StiffnessFactor& factor, const EigenPairs& exact,
                    const Eigen::MatrixXd& loads);

  Eigen::Index size() const { return room_for_vectors_.rows(); }
  Eigen::Index num_loads() const { return static_flexibility_.size(); }
  Eigen::Index num_vectors() const { return num_vectors_; }

  /// Elastic displacement of each load's own freedom under it, at rest: diag(BᵀK⁻¹B), b [m/N, rad/(N·m)].
  const Eigen::VectorXd& static_flexibility() const { return static_flexibility_; }

  /// Adds vectors to the basis. What they hold of the exact modes is taken away.
  /// @param added  n×j, not dependent on each other or on those of the basis
  void add(Eigen::MatrixXd added);

  /// Adds loads behind those given at the beginning.
  /// @param loads  n×j, balanced
  void add_loads(Eigen::MatrixXd loads);

  /// Amplitudes of the basis under each load, by Galerkin's condition, in the coordinates of ritz().
  /// @return m×b
  Eigen::MatrixXd calc_amplitudes(double s) const;

  /// D of each load for given amplitudes, at the expense of m²b operations.
  /// @param amplitudes  m×b
  /// @return b, ≥ 0
  Eigen::VectorXd calc_errors(double s, const Eigen::MatrixXd& amplitudes) const;
  /// Work of each load's share that no exact mode takes on the displacements of each at rest.
  /// @return b×b
  Eigen::MatrixXd calc_load_work() const;
  /// D of all pairs of loads.
  /// @param load_work  as from calc_load_work, which takes b²n operations
  /// @return b×b, symmetric
  Eigen::MatrixXd calc_error_matrix(const Eigen::MatrixXd& load_work, double s,
                                    const Eigen::MatrixXd& amplitudes) const;

  /// rᴴK⁻¹r of each load, with Galerkin's amplitudes, for a body with stiffness (1 + iη)K.
  /// @param loss_factor  η ≥ 0; 2 ζ for the modal damping ratio ζ (reduce/certificate, "Damping")
  /// @return b, ≥ 0
  Eigen::VectorXd calc_damped_errors(double s, double loss_factor) const;

  /// K⁻¹r of a load: the direction that lessens its error most. @return n
  Eigen::VectorXd make_vector(Eigen::Index load, double s) const;

  /// The vectors added, combined so that VᵀKV is diagonal and Vᵀ(M − QQᵀ)V = I.
  EigenPairs ritz() const;

 private:
  // U, T = K⁻¹(M − QQᵀ)U, n×m
  using Columns = Eigen::MatrixXd::ConstColsBlockXpr;
  Columns vectors() const { return room_for_vectors_.leftCols(num_vectors_); }
  Columns second() const { return room_for_second_.leftCols(num_vectors_); }
  void update_ritz();

  const ModalProblem* problem_;
  const StiffnessFactor* factor_;
  Eigen::MatrixXd exact_, exact_momenta_;  // n×k: Φ, (M − QQᵀ)Φ
  Eigen::VectorXd exact_omega_squared_;    // k
  Eigen::MatrixXd flexible_;               // Z = K⁻¹B_X, n×b
  Eigen::VectorXd load_work_;              // diagonal of B_XᵀZ, b
  Eigen::VectorXd static_flexibility_;
  Eigen::Index num_vectors_ = 0;
  Eigen::MatrixXd room_for_vectors_, room_for_second_;  // n×(m or more)
  Eigen::MatrixXd loads_;                               // B_X
  // Products of the vectors as added, and their Ritz form.
  Eigen::MatrixXd UKU_, UMU_, TMU_, BU_, BT_;
  Eigen::VectorXd omega_squared_;  // m
  Eigen::MatrixXd rotation_;       // m×m
  Eigen::MatrixXd ritz_TMU_, ritz_BU_, ritz_BT_;
};

}  // namespace sprung::reduce

#pragma once

#include <Eigen/Core>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/system/block_jacobian.h"
#include "dynamics/system/marker_set.h"
#include "dynamics/system/model.h"
#include "dynamics/system/system_constraints.h"
#include "dynamics/system/system_forces.h"

namespace sprung::dynamics {

/// The terms of the constrained equations M q̈ + φ_qᵀλ = Q, φ_q q̈ = γ at one state, in preallocated storage:
/// the workspace beside the immutable model. It is the one place that knows at which time, q and v the
/// equations stand, and which of the terms belong to them (`has`): new positions put all other terms out of
/// date. Debug builds assert that no term is read that is out of date. nq coordinates, m constraints.
class SystemTerms {
 public:
  /// Which markers are kept up to date.
  enum class Markers {
    kAll,
    kActing,  ///< those that joints and forces see; the others by `update_all_markers`
  };
  /// A term, or group of terms, that is brought up to date by one function.
  enum class Term : unsigned {
    kJointPositions = 1,  ///< of the markers that joints see
    kPositions = 2,       ///< of all markers of the scope
    kJacobian = 4,
    kMass = 8,
    kVelocities = 16,
    kForces = 32,
    kAccelerations = 64,  ///< and multipliers: of ConstrainedEquations, which finds them from the other terms
    kAllMarkers = 128,    ///< positions and velocities of all markers, whatever the scope
  };
  explicit SystemTerms(const Model& model, Markers scope = Markers::kAll);
  /// Whether a term belongs to the present time, q and, where it depends on them, v.
  bool has(Term term) const { return (up_to_date_ & static_cast<unsigned>(term)) != 0; }
  double time() const { return time_; }  ///< [s]
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }
  const Model& model() const { return *model_; }

  /// Positions of the markers: `place_joints` and `place_others`.
  void update_positions(double time, const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Positions of the markers that joints see: residual and Jacobian need no others.
  void place_joints(double time, const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Positions of the other markers, at the q of the last `place_joints`.
  void place_others();
  void calc_residual(Eigen::Ref<Eigen::VectorXd> phi) const {  ///< m, of the constraints
    assert(has(Term::kJointPositions));
    constraints_.calc_residual(markers_, time_, phi);
  }
  void update_jacobian() {
    assert(has(Term::kJointPositions));
    constraints_.update_jacobian(markers_);
    set(Term::kJacobian);
  }
  const BlockJacobian& jacobian() const { return constraints_.jacobian(); }  ///< φ_q, m×nq
  void calc_time_rate(Eigen::Ref<Eigen::VectorXd> phi_t) const {             ///< m
    assert(has(Term::kJointPositions));
    constraints_.calc_time_rate(markers_, time_, phi_t);
  }

  void update_mass();
  /// Mass matrix of body b, (3+n)×(3+n), at Body::first_coordinate of the system's block-diagonal M.
  const Eigen::MatrixXd& mass(std::size_t body) const {
    assert(has(Term::kMass));
    return masses_[body].matrix();
  }
  const std::vector<BodyMass>& masses() const { return masses_; }
  /// Diagonal of the metric of the coordinates, nq: masses, with stand-ins for those that are 0 (system, eq.
  /// 3).
  Eigen::VectorXd calc_metric() const;

  /// Velocities of the markers.
  void update_velocities(const Eigen::Ref<const Eigen::VectorXd>& v);
  void calc_gamma(Eigen::Ref<Eigen::VectorXd> gamma) const {  ///< m, right-hand side of φ_q q̈ = γ
    assert(has(Term::kJacobian) && has(Term::kVelocities));
    constraints_.calc_gamma(markers_, time_, gamma);
  }

  /// Generalized forces of all kinds.
  void update_forces(std::span<const int> branches);
  const Eigen::VectorXd& forces() const {  ///< nq
    assert(has(Term::kForces));
    return forces_.generalized();
  }
  const Power& power() const {
    assert(has(Term::kForces));
    return forces_.power();
  }
  /// Forces on modes that come from the run and not from the model: they count from the next `update_forces`
  /// on.
  void set_fading_forces(std::vector<FadingForce> fading) { forces_.set_fading(std::move(fading)); }
  const std::vector<FadingForce>& fading_forces() const { return forces_.fading(); }
  /// Linear laws of damper forces, see SystemForces; from the next `update_forces` on.
  void set_rate_slopes(std::vector<std::vector<double>> slopes) {
    forces_.set_rate_slopes(std::move(slopes));
  }
  /// Forces and torques of force elements, and of joints under multipliers λ, on each marker; after
  /// `update_jacobian` and `update_forces`. @param[out] loads  of all markers, world axes
  void calc_loads(const Eigen::VectorXd& lambda, std::span<Wrench> loads) const;
  /// Of force elements alone, after `update_forces`.
  std::span<const Wrench> force_loads() const {
    assert(has(Term::kForces));
    return forces_.wrenches();
  }
  /// Says that ConstrainedEquations has found accelerations and multipliers from the present terms.
  void set_has_accelerations() { set(Term::kAccelerations); }

  /// The branches of all force elements that hold at the present positions and velocities.
  void choose_branches(std::span<int> branches) const;
  std::vector<int> find_branches() const;  ///< the same
  /// Positions and velocities of all markers at the present q and v, whatever the scope.
  void update_all_markers();
  std::span<const MarkerState> markers() const {
    assert(has(Term::kPositions));
    return markers_;
  }
  const FrameRotation& rotation(std::size_t body) const {
    assert(has(Term::kJointPositions));
    return rotations_[body];
  }
  /// With the states of force element f; after update_velocities.
  Instant instant_of(std::size_t f) const {
    return {time_, markers(), model_->states_of(f, v_.data()), forces_.rate_slopes_of(f)};
  }

 private:
  void set_only(Term term) { up_to_date_ = static_cast<unsigned>(term); }
  void set(Term term) { up_to_date_ |= static_cast<unsigned>(term); }
  void reset(Term term) { up_to_date_ &= ~static_cast<unsigned>(term); }

  const Model* model_;
  MarkerSet joint_markers_, other_markers_;  // of the scope
  MarkerSet idle_markers_;                   // outside of it
  std::vector<int> angles_;                  // coordinates, of each body
  std::vector<std::size_t> varying_bodies_;  // whose mass matrix depends on the state
  unsigned up_to_date_ = 0;                  // set of Term
  double time_ = 0.0;
  Eigen::VectorXd q_, v_;
  std::vector<FrameRotation> rotations_;
  std::vector<NearbyRotation> nearby_rotations_;
  std::vector<MarkerState> markers_;
  std::vector<BodyMass> masses_;
  SystemConstraints constraints_;
  SystemForces forces_;
};

/// Derivative of a marker's motion (δx, δy, δangle), world axes, with respect to the coordinates: 3×nq.
/// @param terms  evaluated so that the marker's position is up to date
Eigen::MatrixXd calc_marker_jacobian(const SystemTerms& terms, int marker);

}  // namespace sprung::dynamics

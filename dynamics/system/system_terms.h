#pragma once

#include <Eigen/Core>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/system/block_jacobian.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The terms of the constrained equations M q̈ + φ_qᵀλ = Q, φ_q q̈ = γ at one state, in preallocated storage:
/// the workspace beside the immutable model. It knows its time, q and v and which of its terms belong to them
/// (`has`); new positions make all others out of date. Debug builds assert that no term is read that is out
/// of date. nq coordinates, m constraints.
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
    kAllMarkers = 64,  ///< positions and velocities of all markers, whatever the scope
  };
  explicit SystemTerms(const Model& model, Markers scope = Markers::kAll);
  /// Whether a term belongs to the present time, q and, where it depends on them, v.
  bool has(Term term) const { return (up_to_date_ & static_cast<unsigned>(term)) != 0; }

  /// Positions of the markers: `place_joints` and `place_others`.
  void update_positions(double time, const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Positions of the markers that joints see, all that residual and Jacobian need.
  void place_joints(double time, const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Positions of the other markers, where the joints' are now.
  void place_others();
  void calc_residual(Eigen::Ref<Eigen::VectorXd> phi) const;  ///< m, of the constraints
  void update_jacobian();
  const BlockJacobian& jacobian() const { return Phi_q_; }       ///< φ_q, m×nq; its pattern is always right
  void calc_time_rate(Eigen::Ref<Eigen::VectorXd> phi_t) const;  ///< m

  void update_mass();
  /// Mass matrix of body b, (3+n)×(3+n), at Body::first_coordinate of the system's block-diagonal M.
  const Eigen::MatrixXd& mass(std::size_t body) const {
    assert(has(Term::kMass));
    return masses_[body].matrix();
  }
  const std::vector<BodyMass>& masses() const { return masses_; }

  /// Velocities of the markers.
  void update_velocities(const Eigen::Ref<const Eigen::VectorXd>& v);
  void calc_gamma(Eigen::Ref<Eigen::VectorXd> gamma) const;  ///< m, right-hand side of φ_q q̈ = γ

  /// Generalized forces of force elements, gravity, stiffness, damping and quadratic velocity terms.
  void update_forces(std::span<const int> branches);
  const Eigen::VectorXd& forces() const {  ///< nq
    assert(has(Term::kForces));
    return Q_;
  }
  const Power& power() const {
    assert(has(Term::kForces));
    return power_;
  }
  /// What force elements, and joints under multipliers λ, do to each marker; after `update_jacobian` and
  /// `update_forces`. @param[out] loads  of all markers, world axes
  void calc_loads(const Eigen::VectorXd& lambda, std::span<Wrench> loads) const;

  void choose_branches(std::span<int> branches) const;
  /// Positions and velocities of all markers at the present q and v, whatever the scope.
  void update_all_markers();

  double time() const { return time_; }  ///< [s]
  std::span<const MarkerState> markers() const {
    assert(has(Term::kPositions));
    return markers_;
  }
  Instant instant() const { return {time_, markers()}; }
  const Model& model() const { return *model_; }
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }

 private:
  // A marker that moves, and where its body's coordinates are; of one on a rigid body all that its position
  // needs.
  struct MovingMarker {
    std::size_t marker, body;
    int first_coordinate, num_coordinates;
    Eigen::Vector2d p_BP;
    double alpha_BP;
    bool is_rigid() const { return num_coordinates == 3; }
  };
  // A rigid body about its centre of mass: what its weight needs.
  struct ConstantBody {
    int first_coordinate;
    double mass;
  };
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
  // Where a joint's Jacobian by its markers is constant, all that changes in its row on a body: by the angle
  // and the modes.
  struct TurningRow {
    std::size_t value;  // the first of them in φ_q
    std::size_t marker;
    MarkerRow G;
  };
  void set_only(Term term) { up_to_date_ = static_cast<unsigned>(term); }
  void set(Term term) { up_to_date_ |= static_cast<unsigned>(term); }
  void reset(Term term) { up_to_date_ &= ~static_cast<unsigned>(term); }
  MovingMarker find_body(int marker_index) const;
  void place_markers(std::span<const MovingMarker> markers);
  void move_markers(std::span<const MovingMarker> markers);
  void add_joint(std::size_t joint);
  void add_block(const JointTerms& terms, JointSide& side);
  void fill_once(const JointTerms& terms);
  static void fill_turning(const MarkerRow& G, const MarkerState& state, double* values);
  static void fill_modal(const MarkerRow& G, const MarkerState& state, double* values);
  void fill_block(const JointSide& side);
  void add_body_forces(std::size_t body);
  void add_wrench(const MovingMarker& moving, const Wrench& wrench, Eigen::VectorXd& Q) const;

  const Model* model_;
  std::vector<MovingMarker> joint_markers_, other_markers_;  // that are kept up to date
  std::vector<MovingMarker> acting_markers_;
  std::vector<int> angles_;  // coordinates, of each body
  std::vector<ConstantBody> constant_bodies_;
  std::vector<std::size_t> varying_bodies_;
  unsigned up_to_date_ = 0;  // set of Term
  double time_ = 0.0;
  Eigen::VectorXd q_, v_, Q_;
  std::vector<FrameRotation> rotations_;
  std::vector<NearbyRotation> nearby_rotations_;
  std::vector<MarkerState> markers_;
  std::vector<BodyMass> masses_;
  std::vector<Wrench> wrenches_;
  std::vector<JointTerms> joints_;
  std::vector<TurningRow> turning_rows_;
  std::vector<std::size_t> filled_joints_;  // whose blocks are filled anew each time, as their G is
  BlockJacobian Phi_q_;
  Power power_;
};

/// Kinetic and stored energy at the state of the terms (positions, mass, velocities up to date) [J].
struct Energy {
  double kinetic = 0.0;
  double strain = 0.0;   ///< of the modes
  double gravity = 0.0;  ///< potential, zero at the world's origin
  double spring = 0.0;   ///< stored in force elements
  double total() const { return kinetic + strain + gravity + spring; }
};
Energy calc_energy(const SystemTerms& terms, std::span<const int> branches);

}  // namespace sprung::dynamics

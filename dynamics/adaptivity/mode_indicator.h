#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/adaptivity/ringing.h"
#include "dynamics/adaptivity/unbalanced_force.h"
#include "dynamics/functions/oscillator_response.h"
#include "dynamics/integration/ode_system.h"
#include "dynamics/linear/linearisation.h"
#include "dynamics/system/constrained_equations.h"
#include "dynamics/system/held_modes.h"

namespace sprung::dynamics {

/// What a modal coordinate does, as a share of the largest that there has been so far.
struct ModeShare {
  double deflection = 0.0;    ///< of any named point of a flexible body
  double acceleration = 0.0;  ///< of that of the points asked for of which it is the largest
  double worst() const { return deflection > acceleration ? deflection : acceleration; }
};

/// Error indicator of modes that a run leaves out. Each is followed as an oscillator under the force that the
/// run leaves unbalanced on it,
///     m_j ξ̈ + c_j ξ̇ + k_j ξ = r_j(t),   r = Q − M q̈ − φ_qᵀ λ in its row,
/// with the mass, damping and stiffness that it has where everything else gives way by its inertia. ξ is what
/// the mode would add to first order, resonance included (adaptivity, eqs. 1–3).
class ModeIndicator {
 public:
  /// @param full    the model with every mode that could be active; has to outlive this
  /// @param time, q  of the start, in coordinates of `full`: masses and stiffnesses are taken there
  /// @param points  markers whose motion is asked for
  /// @param linearised  of `full` about that start, where it is known; else it is found
  ModeIndicator(const Model& full, double time, const Eigen::VectorXd& q, std::vector<int> points,
                const LinearisedSystem* linearised = nullptr);

  /// Small motion about the start where modes are held: that of the full model, without their rows and
  /// columns.
  /// @param held  of `full`, with the modes that are active
  /// @return none where a mode that is held is not independent in the full model
  std::optional<KnownMotion> calc_small_motion(const HeldModes& held) const;

  /// Modal coordinates of `full`, ascending; all arrays below are in this order.
  const std::vector<int>& modal_coordinates() const { return modal_; }
  std::size_t num_modes() const { return modal_.size(); }

  /// Says which modes are active from the last update on; those that stop being so begin at rest where they
  /// are held. What gives way to the others is another then: their vibration about where the force would hold
  /// them stays.
  void set_active(const std::vector<bool>& is_active_coordinate);
  bool is_active(std::size_t mode) const { return active_[mode]; }

  /// Goes on to the next instant of the run; at the same instant again, where forces have jumped.
  /// @param run          equations of the model that is run, accelerations up to date
  /// @param q, v, v_dot  in coordinates of `full`, held ones at rest
  void update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
              const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);

  /// What a mode left out would do: amplitude of its coordinate and of that one's acceleration.
  struct LeftOut {
    double amplitude = 0.0, acceleration = 0.0;
  };
  /// At the last update. Zero for active ones.
  const std::vector<LeftOut>& left_out() const { return left_out_; }
  /// The same as shares of the largest so far.
  const std::vector<ModeShare>& neglected() const { return neglected_; }
  /// What a deflection and an acceleration of one modal coordinate would be of the largest so far.
  ModeShare share(std::size_t mode, double amplitude, double acceleration) const;
  /// What a mode left out would do to what is asked for.
  struct Reached {
    double deflection = 0.0;           ///< [m]
    std::vector<double> acceleration;  ///< of each asked point [m/s²]
  };
  /// With what gives way to the mode now.
  void calc_reached(std::size_t mode, const LeftOut& left_out, Reached& reached) const;
  /// Shares of the largest so far.
  ModeShare share(const Reached& reached) const;
  /// The force that the run leaves unbalanced on a mode left out, at the last update.
  double unbalanced_force(std::size_t mode) const { return oscillators_[mode].force; }
  /// The part of it that was there before, without what has jumped at this very instant (or with what the run
  /// starts).
  double held_force(std::size_t mode) const { return oscillators_[mode].held_force; }
  /// Time to let go of what held modes that have just become active: after it each asked point rings by at
  /// most a share of its largest acceleration so far.
  /// @param forces   on `coordinates` [N/kg^½]
  /// @param longest  where that is not enough, or not known [s]
  double calc_release_time(const std::vector<int>& coordinates, const std::vector<double>& forces,
                           double share, double longest) const;
  /// What stopping each of the modes sets ringing, where all of them are left out: an impulse on what stays
  /// active.
  /// @param v  in coordinates of `full`
  /// @return largest share of any asked point's largest acceleration so far, for each of `coordinates`
  std::vector<double> calc_stopping_shares(const std::vector<int>& coordinates,
                                           const Eigen::VectorXd& v) const;
  /// Frequency with everything else giving way [Hz].
  double frequency(std::size_t mode) const;
  double time() const { return time_; }  ///< of the last update

  /// What a mode left out would do.
  struct Oscillator {
    double place = 0.0, rate = 0.0;  ///< ξ, ξ̇
    double force = 0.0;              ///< r at the last update
    double held_force = 0.0;         ///< the same but for what has jumped at that instant; 0 at the start
    bool is_fresh = false;           ///< left out since that instant
  };
  /// What has to be kept to go back to an instant. The largest that shares refer to stay what they have
  /// become: they are known then, though they are still to come.
  struct Memory {
    double time = 0.0;
    bool has_begun = false;
    std::vector<Oscillator> oscillators;
  };
  void remember(Memory& memory) const;
  void go_back(const Memory& memory);

 private:
  // The mode with what gives way to it.
  struct Effective {
    double mass = 0.0, damping = 0.0, stiffness = 0.0;
    std::vector<double> reach = {};  // displacement of each asked point
    double step = 0.0;               // that `response` is over
    OscillatorResponse response = {};
  };
  void stack_shapes();
  std::vector<Eigen::Index> find_free(const std::vector<bool>& active) const;
  Ringing make_ringing(const std::vector<Eigen::Index>& free) const;
  void update_effective();
  Effective make_alone(int coordinate) const;
  void raise_references(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);
  void follow(std::size_t mode, double step);
  template <class Change>
  ModeShare calc_share(double deflection, const Change& change_at) const;

  const Model* full_;
  UnbalancedForce unbalanced_;
  std::vector<int> points_;
  std::vector<MarkerState> point_states_;
  std::vector<int> modal_;
  std::vector<bool> active_;

  // About the start: small motion in the independents.
  std::vector<int> independent_;
  Eigen::MatrixXd mass_, damping_, stiffness_;
  std::vector<Eigen::Matrix2Xd> point_motion_;   // of each point, per coordinate of `full`
  std::vector<Eigen::MatrixXd> reduced_motion_;  // per independent coordinate

  std::vector<Effective> effective_;
  std::vector<Eigen::MatrixXd>
      shapes_;                   // of each body: deflections of its named points, two rows each, by its modes
  Eigen::VectorXd deflections_;  // of one body
  std::vector<double> bending_;  // largest deflection of a named point per unit of the mode
  std::vector<Oscillator> oscillators_;
  std::vector<LeftOut> left_out_;
  std::vector<ModeShare> neglected_;
  double time_ = 0.0;
  bool has_begun_ = false;
  double largest_deflection_ = 0.0;
  std::vector<double> largest_acceleration_;  // of each asked point
};

}  // namespace sprung::dynamics

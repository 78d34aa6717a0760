#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/adaptivity/effective_modes.h"
#include "dynamics/adaptivity/full_small_motion.h"
#include "dynamics/adaptivity/reference_sizes.h"
#include "dynamics/adaptivity/step_responses.h"
#include "dynamics/adaptivity/unbalanced_force.h"
#include "dynamics/system/constrained_equations.h"

namespace sprung::dynamics {

/// Amplitudes of the oscillation that a mode left out would have: of its coordinate and of that one's
/// acceleration.
struct ModeAmplitude {
  double amplitude = 0.0, acceleration = 0.0;
};

/// Error indicator of modes that a run leaves out. Each is followed as an oscillator under the force that the
/// run leaves unbalanced on it,
///     m_j ξ̈ + c_j ξ̇ + k_j ξ = r_j(t),   r = Q − M q̈ − φ_qᵀ λ in its row,
/// with the mass, damping and stiffness that it has where everything else gives way to it. ξ is, to
/// first order, what the mode would add to the motion, resonance included (adaptivity, eqs. 1–3).
class ModeIndicator {
 public:
  /// @param full    the model with every mode that could be active; has to outlive this
  /// @param time, q  of the start, in coordinates of `full`: masses and stiffnesses are taken there
  /// @param points  markers whose motion is asked for
  /// @param linearised  of `full` about that start, where it is known; else it is found
  ModeIndicator(const Model& full, double time, const Eigen::VectorXd& q, const std::vector<int>& points,
                const LinearisedSystem* linearised = nullptr);
  ModeIndicator(const ModeIndicator&) = delete;  // its parts refer to each other

  const FullSmallMotion& small_motion() const { return motion_; }
  const ReferenceSizes& sizes() const { return sizes_; }
  /// Modal coordinates of `full`, ascending; all arrays below are in this order.
  const std::vector<int>& modal_coordinates() const { return motion_.modal_coordinates(); }
  std::size_t num_modes() const { return active_.size(); }
  std::size_t mode_of(int coordinate) const;  ///< its place in them

  /// Sets the modes that are active from the last update on; those that stop being so begin at rest where
  /// they are held. Then something else gives way to the others: they keep their vibration about the place
  /// where the force would hold them.
  void set_active(const std::vector<bool>& is_active_coordinate);
  const std::vector<bool>& active() const { return active_; }  ///< of each mode

  /// Before the first update: the run continues an earlier one, whose forces have held the modes left out.
  void continue_run();
  /// Before the first update: the modes begin where they are held, not in balance with the forces on them.
  void begin_at_rest() { is_balanced_ = false; }

  /// Continues to the next instant of the run, or to the same one again where forces have jumped.
  /// @param run          equations of the model that is run, accelerations up to date
  /// @param q, v, v_dot  in coordinates of `full`, held ones at rest
  void update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
              const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);
  double time() const { return state_.time; }  ///< of the last update

  /// At the last update, of each mode; zero for active ones.
  const std::vector<ModeAmplitude>& amplitudes() const { return amplitudes_; }
  /// The same of one mode, as a share of the largest so far.
  ModeShare calc_neglected(std::size_t mode) const { return calc_share(mode, amplitudes_[mode]); }
  /// Share of a mode with such amplitudes.
  ModeShare calc_share(std::size_t mode, const ModeAmplitude& amplitude) const;
  /// Deflection and acceleration of the points asked for, by a mode with what gives way to it now.
  double calc_deflection(std::size_t mode, const ModeAmplitude& amplitude) const {
    return effective_[mode].deflection * amplitude.amplitude;  ///< [m]
  }
  double calc_acceleration(std::size_t mode, std::size_t point, const ModeAmplitude& amplitude) const {
    return effective_[mode].reach[point] * amplitude.acceleration;  ///< [m/s²]
  }
  /// The force that the run leaves unbalanced on a mode left out, at the last update; 0 for an active one
  /// [N/√kg].
  double unbalanced_force(std::size_t mode) const { return state_.oscillators[mode].force; }
  /// The part of the force that the run leaves unbalanced on a mode left out that was there before the last
  /// update: without the part that has jumped at that very instant, or with which the run starts, unless it
  /// continues another.
  double held_force(std::size_t mode) const { return state_.oscillators[mode].held_force; }
  /// Frequency with everything else giving way [Hz].
  double calc_frequency(std::size_t mode) const { return effective_.calc_frequency(mode); }

  /// The state of a mode left out.
  struct Oscillator {
    double place = 0.0, rate = 0.0;  ///< ξ, ξ̇
    double force = 0.0;              ///< r at the last update
    double held_force = 0.0;         ///< the part of it that has not jumped at that instant; 0 at the start
    bool is_fresh = false;           ///< left out since that instant
  };
  /// All that an update changes but the largest sizes: these stay known when the run goes back in time.
  struct State {
    double time = 0.0;
    bool has_begun = false;
    std::vector<Oscillator> oscillators;  // of each mode
  };
  const State& state() const { return state_; }
  /// Goes back to an earlier instant, with the same active modes.
  void set_state(const State& state) { state_ = state; }

  /// State and largest sizes as bytes, and back into an indicator with the same start and active modes.
  void save(support::ByteWriter& bytes) const;
  void restore(support::ByteReader& bytes);  ///< @throws support::DamagedBytes

 private:
  void update_left_out();
  void follow(std::size_t place, double step);  // the mode at that place among those left out
  template <class Bytes, class Indicator>
  static void transfer(Bytes& bytes, Indicator& indicator);

  FullSmallMotion motion_;
  std::vector<bool> active_;
  EffectiveModes effective_;
  ReferenceSizes sizes_;
  UnbalancedForce unbalanced_;
  State state_;
  bool is_balanced_ = true;  // at the start
  std::vector<std::size_t> left_out_;
  StepResponses responses_;  // of the modes left out
  std::vector<ModeAmplitude> amplitudes_;
};

}  // namespace sprung::dynamics

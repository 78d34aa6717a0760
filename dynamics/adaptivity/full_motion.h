#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/system/constrained_equations.h"
#include "dynamics/system/held_modes.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

/// Motion in coordinates of a full model, while models are run in which some of its modes are held: it
/// carries the state from one such model to the next (system, eq. 12; adaptivity, eqs. 4, 5).
class FullMotion {
 public:
  /// @param full   has to outlive this
  /// @param start  in its coordinates
  FullMotion(const Model& full, const State& start);

  /// Takes the motion of the equations of a model that is run; held modes stay where they are, at rest.
  void take(const HeldModes& held, const ConstrainedEquations& equations);
  /// Goes to other positions and velocities.
  void go_to(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }
  const Eigen::VectorXd& v_dot() const { return v_dot_; }
  /// Strain energy of the modes that are not active [J]. No stiffness couples them with the others.
  double calc_held_strain(const std::vector<bool>& is_active) const;

  /// A model in which all modes but the active ones are held where they are now.
  /// @param is_active  for each coordinate of the full model
  HeldModes hold(const std::vector<bool>& is_active) const;
  /// The state here for a model made by `hold`, with the forces that still fade on its modes.
  State state_for(const HeldModes& held, double time, const std::vector<int>& branches) const;

  /// Releases a mode that has been held: −r, the force that held it, acts on it from now on and fades within
  /// `duration`.
  /// @param coordinate  of the full model   @param force  −r [N/√kg]   @param time, duration  [s]
  void release(int coordinate, double force, double time, double duration);
  /// The forces of `release`, on coordinates of the full model; some may have faded.
  const std::vector<FadingForce>& fading() const { return fading_; }
  /// Stops modes where they are, by an impulse on them alone: all others keep their momentum, except for the
  /// impulses of the joints (adaptivity, eq. 5).
  /// @param held  made by `hold` without them
  /// @return energy lost by it [J]
  /// @throws support::NumericalError if the joints cannot be closed
  double stop(const std::vector<int>& coordinates, const HeldModes& held, double time,
              std::span<const int> branches);

  /// Positions, velocities and the forces that fade, as bytes and back.
  void save(support::ByteWriter& bytes) const { transfer(bytes, *this); }
  void restore(support::ByteReader& bytes);  ///< @throws support::DamagedBytes

 private:
  template <class Bytes, class Motion>
  static void transfer(Bytes& bytes, Motion& motion) {
    bytes.transfer(motion.q_);
    bytes.transfer(motion.v_);
    bytes.transfer_items(motion.fading_, [&](auto& one) {
      bytes.transfer(one.coordinate);
      bytes.transfer(one.force);
      bytes.transfer(one.start);
      bytes.transfer(one.duration);
    });
  }
  void update_terms(double time);

  const Model* full_;
  SystemTerms terms_;
  std::vector<FadingForce> fading_;  // on coordinates of the full model
  Eigen::VectorXd q_, v_, v_dot_;
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/integration/ode_system.h"
#include "dynamics/linear/linearisation.h"
#include "dynamics/system/held_modes.h"

namespace sprung::dynamics {

/// Small motion of a full model about the start of a run, in f independent coordinates, and the motion of the
/// points asked for. Near a singular position, or where the mass is singular, there is none: then f = 0. nq
/// coordinates.
///
/// The modes are among the independent coordinates, as far as the joints leave them free: a mode that is held
/// stands still only if it is one of them (adaptivity, "Indicator"). An integrator may have chosen others.
class FullSmallMotion {
 public:
  /// @param full        with every mode that could be active; has to outlive this
  /// @param time, q     of the start, nq
  /// @param points      markers whose motion is asked for
  /// @param linearised  of `full` about the start, where it is known; else it is found
  FullSmallMotion(const Model& full, double time, const Eigen::VectorXd& q, const std::vector<int>& points,
                  const LinearisedSystem* linearised);

  const Model& model() const { return *full_; }
  /// Modal coordinates of the full model, ascending: mode j of the functions below has coordinate j here.
  const std::vector<int>& modal_coordinates() const { return modal_; }
  const SmallMotion& motion() const { return motion_; }  ///< f×f
  const Eigen::MatrixXd& stiffness_rounding() const { return stiffness_rounding_; }
  const std::vector<int>& independent() const { return independent_; }  ///< coordinates of the full model, f
  /// Place of a coordinate among the independent ones, −1 for a dependent one.
  Eigen::Index find_independent(int coordinate) const;
  /// Places among the independent coordinates of all but those of modes that are not active.
  std::vector<Eigen::Index> find_free(const std::vector<bool>& is_active) const;
  /// Motion ∂r/∂q of a point asked for: 2×nq, and with the joints closed 2×f.
  const Eigen::Matrix2Xd& point_motion(std::size_t point) const { return point_motion_[point]; }
  const Eigen::MatrixXd& reduced_motion(std::size_t point) const { return reduced_motion_[point]; }
  /// Motion of the modal coordinates with the joints closed, modes×f; a unit row where a mode is independent.
  const Eigen::MatrixXd& modal_motion() const { return modal_motion_; }
  std::size_t num_points() const { return point_motion_.size(); }

  /// Small motion where modes are held: without their rows and columns.
  /// @param held  of the full model
  /// @return in the independent coordinates of `linearised`; none where a mode that is held is not one of
  /// them
  std::optional<KnownMotion> calc_held_motion(const HeldModes& held) const;

 private:
  bool is_modal(int coordinate) const;
  void make_independent(int coordinate, Eigen::MatrixXd& directions);
  void sort_coordinates(Eigen::MatrixXd& directions);

  const Model* full_;
  std::vector<int> modal_, independent_;
  SmallMotion motion_;
  Eigen::MatrixXd stiffness_rounding_;
  KnownMotion known_;  // in the coordinates of the linearisation
  Eigen::MatrixXd modal_motion_;
  std::vector<Eigen::Matrix2Xd> point_motion_;
  std::vector<Eigen::MatrixXd> reduced_motion_;
};

}  // namespace sprung::dynamics

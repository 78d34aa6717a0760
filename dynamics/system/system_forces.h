#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "dynamics/bodies/body_forces.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The motion that forces depend on. nq coordinates.
struct SystemMotion {
  double time;                               ///< [s]
  const Eigen::VectorXd &q, &v;              ///< nq
  std::span<const FrameRotation> rotations;  ///< of each body
  std::span<const BodyMass> masses;          ///< of each body, up to date
  std::span<const MarkerState> markers;      ///< positions and velocities up to date
};

/// The generalized forces Q of force elements, gravity, stiffness, damping and quadratic velocity terms
/// (system, eq. 1; bodies, eqs. 4, 5, 12), in preallocated storage.
class SystemForces {
 public:
  /// @param model has to outlive this   @param masses  of its bodies
  SystemForces(const Model& model, const std::vector<BodyMass>& masses);

  /// Forces that act on modes from now on, beside those of the model.
  void set_fading(std::vector<FadingForce> fading) { fading_ = std::move(fading); }
  const std::vector<FadingForce>& fading() const { return fading_; }

  /// Linear laws in the place of those of damper forces (Instant::rate_slopes), one entry for each force
  /// element; empty: none.
  void set_rate_slopes(std::vector<std::vector<double>> slopes) { rate_slopes_ = std::move(slopes); }
  std::span<const double> rate_slopes_of(std::size_t force) const {
    return rate_slopes_.empty() ? std::span<const double>() : std::span<const double>(rate_slopes_[force]);
  }

  /// @param branches  num_branches
  void update(const SystemMotion& motion, std::span<const int> branches);
  const Eigen::VectorXd& generalized() const { return Q_; }  ///< Q, nq
  const Power& power() const { return power_; }
  std::span<const Wrench> wrenches() const { return wrenches_; }  ///< of the force elements on each marker

 private:
  // A marker that force elements or joints act on, and where its body's coordinates are.
  struct ActingMarker {
    std::size_t marker;
    int first_coordinate, num_coordinates;
  };
  // A rigid body about its centre of mass: all that its weight needs.
  struct ConstantBody {
    int first_coordinate;
    double mass;
  };
  struct VaryingBody {
    std::size_t body;
    int first_coordinate;
    BodyForces forces;
  };
  void add_wrench(const ActingMarker& acting, const MarkerState& state);
  void set_state_rates(const SystemMotion& motion, std::span<const int> branches);
  void add_fading_forces(const SystemMotion& motion);

  const Model* model_;
  std::vector<ActingMarker> acting_markers_;
  std::vector<ConstantBody> constant_bodies_;
  std::vector<VaryingBody> varying_bodies_;
  std::vector<FadingForce> fading_;
  std::vector<std::vector<double>> rate_slopes_;
  std::vector<Wrench> wrenches_;
  Eigen::VectorXd Q_;
  Power power_;
};

}  // namespace sprung::dynamics

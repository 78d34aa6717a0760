#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"
#include "reduce/superelement/superelement.h"

namespace sprung::dynamics {

/// The loads on a body at an instant, in its own axes, as coefficients of unit loads: for each marker on
/// which joints or forces act a force along x, along y and a moment; for the frame its acceleration less
/// gravity along x, along y, its angular acceleration, and the square of its angular velocity. `update`
/// allocates nothing.
class BodyLoads {
 public:
  /// @param body    0-based, of the model; with a superelement
  /// @param points  of the vehicle, in the order of the model's markers
  BodyLoads(const Model& model, int body, const reduce::Superelement& superelement,
            const std::vector<VehiclePoint>& points);

  Eigen::Index size() const { return coefficients_.size(); }
  /// Per coefficient, a quantity that is linear in the loads.
  /// @param point_load    under unit loads on the superelement's points, k×3p
  /// @param acceleration  under the inertia at unit accelerations of the frame, k×4
  /// @return k×size
  Eigen::MatrixXd combine(const Eigen::MatrixXd& point_load, const Eigen::MatrixXd& acceleration) const;

  /// @param loads  force and torque on each marker of the model, world axes
  /// @param q, v, v_dot  of the model
  void update(std::span<const Wrench> loads, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
              const Eigen::VectorXd& v_dot);
  const Eigen::VectorXd& coefficients() const { return coefficients_; }

 private:
  struct LoadedMarker {
    std::size_t marker;
    int point;  // of the superelement; −1: the centre of mass
    Eigen::Vector2d offset;
  };
  int first_;
  double mass_;
  Eigen::Vector2d gravity_;
  std::vector<LoadedMarker> markers_;
  Eigen::VectorXd coefficients_;
};

}  // namespace sprung::dynamics

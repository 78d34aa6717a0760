#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// Markers that are moved together. The displacements of all of them on a flexible body are one product with
/// its modal coordinates.
class MarkerSet {
 public:
  MarkerSet() = default;
  /// @param model    has to outlive this
  /// @param markers  of moving bodies
  MarkerSet(const Model& model, const std::vector<int>& markers);

  /// Positions (bodies, eqs. 1, 11). @param rotations  of each body   @param states  of all markers
  void place(std::span<const FrameRotation> rotations, const Eigen::VectorXd& q,
             std::span<MarkerState> states);
  /// Velocities (bodies, eqs. 2, 11), at the positions last placed. @param states  of all markers
  void move(const Eigen::VectorXd& v, std::span<MarkerState> states);

 private:
  struct OnRigidBody {
    std::size_t marker, body;
    int first_coordinate;
    Eigen::Vector2d p_BP;
    double alpha_BP;
  };
  struct OnFlexibleBody {
    std::size_t body;
    int first_coordinate;
    std::vector<std::size_t> markers;
    Eigen::MatrixXd shapes;        // 3m×n, of the markers one below the other
    Eigen::VectorXd displacement;  // 3m, of the markers or its rate
    bool has_second_order;         // their gradients depend on the modal coordinates
  };
  OnFlexibleBody& find_body(std::size_t body);

  const Model* model_ = nullptr;
  std::vector<OnRigidBody> rigid_;
  std::vector<OnFlexibleBody> flexible_;
};

}  // namespace sprung::dynamics

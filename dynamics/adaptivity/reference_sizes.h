#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "dynamics/system/model.h"
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

/// The effect of a modal coordinate as a share of the largest deflection and acceleration of a run so far.
struct ModeShare {
  double deflection = 0.0;    ///< of any named point of a flexible body
  double acceleration = 0.0;  ///< of the point asked for at which this share is the largest
  double worst() const { return deflection > acceleration ? deflection : acceleration; }
};

/// The largest deflection of any named point of a flexible body and the largest acceleration of each point
/// asked for in a run so far: shares refer to them (adaptivity, eq. 3).
class ReferenceSizes {
 public:
  /// @param full    has to outlive this   @param points  markers
  ReferenceSizes(const Model& full, std::vector<int> points);
  /// Takes the motion of an instant into account. @param q, v, v_dot  of the full model
  void update(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);

  std::size_t num_points() const { return points_.size(); }
  double acceleration(std::size_t point) const { return accelerations_[point]; }  ///< > 0 [m/s²]
  /// At the last update [m/s²].
  const Eigen::Vector2d& present_acceleration(std::size_t point) const { return present_[point]; }
  double least_acceleration() const { return least_acceleration_; }  ///< that counts, > 0 [m/s²]
  /// Shares of a deflection [m] and of an acceleration of a point [m/s²]. A share is at most 1: where a mode
  /// alone would do more than the run, it is the reference itself.
  double calc_deflection_share(double deflection) const {
    return deflection / std::max(deflection_, deflection);
  }
  double calc_acceleration_share(std::size_t point, double acceleration) const {
    return acceleration / std::max(accelerations_[point], acceleration);
  }
  /// Both, of the point with the largest share. @param acceleration_at  of a point [m/s²]
  template <class AccelerationAt>
  ModeShare calc_share(double deflection, const AccelerationAt& acceleration_at) const {
    ModeShare share{.deflection = calc_deflection_share(deflection)};
    for (std::size_t i = 0; i < points_.size(); ++i)
      share.acceleration = std::max(share.acceleration, calc_acceleration_share(i, acceleration_at(i)));
    return share;
  }

  void save(support::ByteWriter& bytes) const { transfer(bytes, *this); }
  void restore(support::ByteReader& bytes) {  ///< @throws support::DamagedBytes
    transfer(bytes, *this);
    if (accelerations_.size() != points_.size()) throw support::DamagedBytes();
  }

 private:
  template <class Bytes, class Sizes>
  static void transfer(Bytes& bytes, Sizes& sizes) {
    bytes.transfer(sizes.deflection_);
    bytes.transfer_items(sizes.accelerations_, [&](auto& value) { bytes.transfer(value); });
  }
  void stack_shapes();

  const Model* full_;
  std::vector<int> points_;
  double deflection_;                  // [m]
  std::vector<double> accelerations_;  // of each point [m/s²]
  double least_acceleration_;
  // Deflections of the named points of each body by its modes, two rows for each point.
  std::vector<Eigen::MatrixXd> shapes_;
  // Work space.
  Eigen::VectorXd deflections_;  // of one body
  std::vector<MarkerState> point_states_;
  std::vector<Eigen::Vector2d> present_;
};

}  // namespace sprung::dynamics

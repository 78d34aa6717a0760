#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace sprung::dynamics {

/// M δq̈ + C δq̇ + K δq = 0: small motion about a state, all f×f.
struct SmallMotion {
  Eigen::MatrixXd mass;  ///< symmetric positive definite
  Eigen::MatrixXd damping, stiffness;
};

/// Small motion in independent coordinates of a model.
struct KnownMotion {
  std::vector<int> independent;  ///< ascending, f
  SmallMotion motion;
};

/// ẏ = f(t, y) with switch functions, as an integrator sees it. y = (q, v, w): f positions with q̇ = v, f
/// velocities, and quadratures w, on which nothing else depends.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;
  virtual int size() const = 0;
  /// f, at most size()/2; 0 for equations of first order.
  virtual int num_freedoms() const = 0;
  /// @return false where f cannot be evaluated; the integrator then tries a shorter step
  virtual bool calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) = 0;
  virtual int num_switches() const = 0;
  /// @param[out] values  positive while the formulas hold that calc_derivative uses, negative beyond;
  ///                     smooth in time
  virtual bool calc_switches(double time, std::span<const double> y, std::span<double> values) = 0;
  /// Natural size of each component: the relative tolerance times this is the error allowed in a step.
  virtual void calc_error_scales(std::span<const double> y, std::span<double> scales) const = 0;
  /// Makes these smaller for integrators that take several steps in each period of vibration: such that
  /// accelerations have the tolerance, too.
  /// @param[in,out] scales  those of calc_error_scales
  virtual void limit_to_accelerations(std::span<const double> /*y*/, std::span<double> /*scales*/) const {}

  /// Small motion about (time, y), for integrators that treat it separately. It need not be exact.
  /// @return false where it cannot be found
  virtual bool calc_small_motion(double time, std::span<const double> y, SmallMotion& motion) = 0;
  /// Freedoms that deform bodies, ascending, for the same integrators.
  virtual std::vector<int> elastic_freedoms() const { return {}; }
  /// Columns of the mass matrix of small motion about (time, y), one for each freedom asked for.
  /// @return false where they cannot be found
  virtual bool calc_mass_columns(double /*time*/, std::span<const double> /*y*/,
                                 const std::vector<int>& /*freedoms*/, Eigen::MatrixXd& /*columns*/) {
    return false;
  }
  /// Changes whenever the meaning of the coordinates in y changes.
  virtual int coordinate_version() const { return 0; }
};

}  // namespace sprung::dynamics

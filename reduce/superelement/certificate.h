#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sprung::reduce {

/// What a vector of a basis is (reduce/basis, "Kinds of vectors"). Only of a free mode, and of a mode of the
/// body held at its reference node, the frequency is one that the body has.
inline constexpr const char* kFreeVector = "free";          ///< mode of the free body
inline constexpr const char* kResidualVector = "residual";  ///< response to interface loads
inline constexpr const char* kClampedVector = "clamped";    ///< mode of the body held at its reference node
inline constexpr const char* kFixedInterfaceVector =
    "fixed-interface";                                          ///< mode of the body held at its interface
inline constexpr const char* kConstraintVector = "constraint";  ///< response to interface displacements

/// Stands for an error that has no bound, which a file cannot hold otherwise.
inline constexpr double kUnbounded = 1e300;

/// What a basis misses of the response of one interface freedom to a unit load in it. Shares are of the
/// static flexibility.
struct InterfaceError {
  int point = 0;                    ///< 0-based, of the superelement's points
  int freedom = 0;                  ///< 0: x, 1: y, 2: rotation
  double static_flexibility = 0.0;  ///< elastic displacement of the free body under it [m/N, rad/(N·m)]
  double static_error = 0.0;        ///< share that the basis misses at rest
  double error = 0.0;               ///< bound of the share over the band; kUnbounded where there is none
  double worst_hz = 0.0;            ///< where the bound is the largest
};

/// A proved bound of what a basis misses of the free body's response to loads at its interface
/// (reduce/certificate).
struct Certificate {
  double highest_hz = 0.0;  ///< the band is 0 … highest_hz
  double tolerance = 0.0;   ///< share asked for; 0 where none was
  double cutoff_hz = 0.0;   ///< the lowest free mode that the basis does not hold exactly; 0: it holds all
  double rounding_floor = 0.0;  ///< shares below it are rounding
  Eigen::VectorXd free_hz;      ///< k, free modes, counted, below 1.5 highest_hz
  Eigen::VectorXd free_error;   ///< k, relative error of the basis in each frequency; kUnbounded: it has none
  std::vector<InterfaceError> interface;  ///< b
  /// q×b: with q more modes at cutoff_hz, which have these shapes at the interface freedoms, the body is
  /// softer than the true one in the band. q = 0 where there is no bound [1/√kg, 1/(m·√kg)]
  Eigen::MatrixXd soft_loads;
  /// q×3: their shapes at the reference node, x, y and rotation. 0×0 in files before version 6
  Eigen::MatrixXd soft_reference;
  /// q: their ∫(x V_x + y V_y) dm about the body frame's origin. Empty in files before version 7
  Eigen::VectorXd soft_radial;
  /// q, 0 … 1: with ω²/share in the place of ω² of these modes, the body deflects at rest as the true one.
  /// Empty in files before version 7, and without such modes
  Eigen::VectorXd soft_static_share;

  bool is_bounded() const;
  /// The largest share over the interface, kUnbounded where there is no bound. 0 without an interface.
  double largest_error() const;
  /// The interface freedom with the largest share, by its bound or, where there is none, at rest. −1 without
  /// an interface.
  int find_worst() const;
};

/// "x", "y" or "rotation". @param freedom 0 … 2
const char* freedom_name(int freedom);

}  // namespace sprung::reduce

#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/beam_model.h"
#include "fem/mass_moments.h"

namespace sprung::fem {

/// Axial force along an element, N(ξ) = constant + linear ξ + quadratic ξ², ξ = x/L; tension positive [N].
struct AxialForce {
  double constant = 0.0, linear = 0.0, quadratic = 0.0;
  double at(double xi) const { return constant + xi * (linear + xi * quadratic); }
};

/// Acceleration of the frame in which a body is at rest, in the mesh's axes: the point at r from the origin
/// has the acceleration a + α S r − ω² r.
struct FrameAcceleration {
  Eigen::Vector2d linear = Eigen::Vector2d::Zero();  ///< a, of the origin [m/s²]
  double angular = 0.0;                              ///< α [rad/s²]
  double omega_squared = 0.0;                        ///< ω² [rad²/s²]
};

/// The inertia of a body at rest in a moving frame, as forces at its nodes (fem, eq. 22).
///
/// @param moments  of the body, about the origin of the frame
/// @return 3N [N, N·m]
Eigen::VectorXd calc_inertia_load(const MassMoments& moments, const FrameAcceleration& acceleration);

/// Axial forces in equilibrium with the loads that displaced a frame. They are exact along the elements; the
/// shape functions alone would give their means (fem, eqs. 23, 24).
///
/// @param displacement  3N, solution of K u = loads at nodes + calc_inertia_load [m, rad]
/// @param acceleration  of the frame about `origin` [m, mesh's axes]
/// @return one for each element
/// @throws std::invalid_argument if the model is not consistent, or the displacement is not of its size
/// Checked by tests/fem/axial_force_test.cpp
std::vector<AxialForce> calc_axial_forces(const BeamModel& model, const Eigen::VectorXd& displacement,
                                          const FrameAcceleration& acceleration,
                                          const Eigen::Vector2d& origin);

/// Axial force of an element without loads between its ends, per displacement of its ends in the mesh's axes;
/// zero for a bushing.
/// @return 1×6 [N/m, N]
Eigen::Matrix<double, 1, 6> calc_axial_row(const BeamElement& element);

/// Axial forces of a frame that forces at its nodes alone displaced: constant along each element.
/// @param displacements  3N×k   @return k columns with a value for each element [N]
Eigen::MatrixXd calc_axial_forces(const BeamModel& model, const Eigen::MatrixXd& displacements);

}  // namespace sprung::fem

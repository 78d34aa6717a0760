#include "fem/geometric_stiffness.h"

#include <cmath>

#include "fem/gauss_points.h"

namespace sprung::fem {

Eigen::Matrix<double, 1, 6> calc_slope(double length, const BeamProperties& properties, double xi) {
  const double Phi = calc_shear_parameter(length, properties);
  const double shear = 0.5 * Phi * (1.0 - 2.0 * xi);
  const double chord = (6.0 * xi * (1.0 - xi) + Phi) / length;
  Eigen::Matrix<double, 1, 6> slope;
  slope << 0.0, -chord, 1.0 - 4.0 * xi + 3.0 * xi * xi + shear, 0.0, chord, 3.0 * xi * xi - 2.0 * xi - shear;
  return slope / (1.0 + Phi);
}

Matrix6 calc_local_geometric_stiffness(double length, const BeamProperties& properties,
                                       const AxialForce& axial_force) {
  Matrix6 K = Matrix6::Zero();
  for (const auto& [xi, weight] : make_gauss_points()) {
    const Eigen::Matrix<double, 1, 6> slope = calc_slope(length, properties, xi);
    K += weight * length * axial_force.at(xi) * slope.transpose() * slope;
  }
  return K;
}

Eigen::Matrix<double, 4, 6> calc_scaled_slopes(const BeamElement& element) {
  const double length = calc_length(element);
  const std::array<GaussPoint, 4> points = make_gauss_points();
  Eigen::Matrix<double, 4, 6> slopes;
  for (int i = 0; i < 4; ++i) {
    const auto& [xi, weight] = points[static_cast<std::size_t>(i)];
    slopes.row(i) = std::sqrt(weight * length) * calc_slope(length, element.properties, xi);
  }
  return slopes * calc_rotation(element);
}

Matrix6 calc_geometric_stiffness(const BeamElement& element, const AxialForce& axial_force) {
  const Matrix6 T = calc_rotation(element);
  return T.transpose() *
         calc_local_geometric_stiffness(calc_length(element), element.properties, axial_force) * T;
}

}  // namespace sprung::fem

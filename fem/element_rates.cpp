#include "fem/element_rates.h"

#include <cmath>

namespace sprung::fem {

namespace {

// What the rates come down to in own axes.
struct LocalRates {
  double length;  // dL/L
  double angle;   // of the element's axis
  double shear;   // dΦ
};

LocalRates calc_local_rates(const BeamElement& element, const BeamElementRates& rates) {
  const Eigen::Vector2d axis = element.second - element.first, change = rates.second - rates.first;
  const double squared = axis.squaredNorm();
  LocalRates local{.length = axis.dot(change) / squared,
                   .angle = (axis.x() * change.y() - axis.y() * change.x()) / squared,
                   .shear = 0.0};
  const BeamProperties& section = element.properties;
  if (std::isinf(section.shear_rigidity)) return local;
  local.shear = calc_shear_parameter(std::sqrt(squared), section) *
                (rates.properties.bending_rigidity / section.bending_rigidity -
                 rates.properties.shear_rigidity / section.shear_rigidity - 2.0 * local.length);
  return local;
}

// Of a matrix c Lᵉ D Â D, D = diag(1, 1, L, 1, 1, L): its rate for dL/L = 1.
Matrix6 calc_length_rate(const Matrix6& matrix, double exponent) {
  Eigen::Matrix<double, 6, 1> rotations;
  rotations << 0.0, 0.0, 1.0, 0.0, 0.0, 1.0;
  return exponent * matrix + rotations.asDiagonal() * matrix + matrix * rotations.asDiagonal();
}

// The rows and columns of axial displacements, or the others. The two do not mix in own axes.
Matrix6 take_part(const Matrix6& matrix, bool axial) {
  Eigen::Matrix<double, 6, 1> taken;
  taken << 1.0, 0.0, 0.0, 1.0, 0.0, 0.0;
  if (!axial) taken = Eigen::Matrix<double, 6, 1>::Ones() - taken;
  return taken.asDiagonal() * matrix * taken.asDiagonal();
}

// dA/dΦ of A(Φ) = P(Φ)/(1+Φ)ᵏ, P a polynomial of the second degree at most: its central difference is exact.
template <typename Calc>
Matrix6 calc_shear_rate(const BeamElement& element, double length, int power, const Calc& calc) {
  const double Phi = calc_shear_parameter(length, element.properties), step = 0.5 * Phi;
  const auto polynomial = [&](double at) -> Matrix6 {
    BeamProperties changed = element.properties;
    changed.shear_rigidity *= Phi / at;
    return std::pow(1.0 + at, power) * calc(length, changed);
  };
  const Matrix6 slope = (polynomial(Phi + step) - polynomial(Phi - step)) / (2.0 * step);
  return (slope - power * std::pow(1.0 + Phi, power - 1) * calc(length, element.properties)) /
         std::pow(1.0 + Phi, power);
}

// Of Tᵀ A T, T the rotation into own axes.
Matrix6 rotate_rate(const BeamElement& element, const Matrix6& local, const Matrix6& rate, double angle) {
  const Matrix6 T = calc_rotation(element);
  Matrix6 T_rate = Matrix6::Zero();
  for (const int end : {0, 3}) {
    T_rate.row(end) = angle * T.row(end + 1);
    T_rate.row(end + 1) = -angle * T.row(end);
  }
  const Matrix6 half = T_rate.transpose() * local * T;
  return T.transpose() * rate * T + half + half.transpose();
}

}  // namespace

Matrix6 calc_stiffness_rate(const BeamElement& element, const BeamElementRates& rates) {
  const double length = calc_length(element);
  const Matrix6 K = calc_local_stiffness(length, element.properties);
  const LocalRates local = calc_local_rates(element, rates);
  const Matrix6 axial = take_part(K, true), bending = take_part(K, false);
  const BeamProperties& section = element.properties;
  Matrix6 rate = rates.properties.axial_rigidity / section.axial_rigidity * axial +
                 rates.properties.bending_rigidity / section.bending_rigidity * bending +
                 local.length * (calc_length_rate(axial, -1.0) + calc_length_rate(bending, -3.0));
  if (local.shear != 0.0) rate += local.shear * calc_shear_rate(element, length, 1, calc_local_stiffness);
  return rotate_rate(element, K, rate, local.angle);
}

Matrix6 calc_mass_rate(const BeamElement& element, const BeamElementRates& rates) {
  const double length = calc_length(element);
  const LocalRates local = calc_local_rates(element, rates);
  BeamProperties translation = element.properties, rotation = element.properties;
  translation.mass_per_length = rotation.rotary_inertia = 1.0;
  translation.rotary_inertia = rotation.mass_per_length = 0.0;
  const Matrix6 of_translation = calc_local_mass(length, translation);
  const Matrix6 of_rotation = calc_local_mass(length, rotation);
  const double rho_A = element.properties.mass_per_length, rho_I = element.properties.rotary_inertia;
  Matrix6 rate =
      rates.properties.mass_per_length * of_translation + rates.properties.rotary_inertia * of_rotation +
      local.length *
          (rho_A * calc_length_rate(of_translation, 1.0) + rho_I * calc_length_rate(of_rotation, -1.0));
  if (local.shear != 0.0) rate += local.shear * calc_shear_rate(element, length, 2, calc_local_mass);
  return rotate_rate(element, rho_A * of_translation + rho_I * of_rotation, rate, local.angle);
}

}  // namespace sprung::fem

#include "fem/beam_element.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sprung::fem {

namespace {

void check_arguments(double length, const BeamProperties& properties, const char* function) {
  if (!(length > 0.0) || std::isinf(length)) {
    throw std::invalid_argument(
        fmt::format("{}: length is {} m, expected a finite value > 0", function, length));
  }
  check_beam_properties(properties, function);
}

// Places the 4×4 bending matrix of the dofs (w₁, ψ₁, w₂, ψ₂) into the element's 6×6.
void add_bending(Matrix6& matrix, const Eigen::Matrix4d& bending) {
  constexpr int kDofs[] = {1, 2, 4, 5};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) matrix(kDofs[i], kDofs[j]) += bending(i, j);
  }
}

// ρA ∫N_wᵀ N_w dx (fem, eq. 11).
Eigen::Matrix4d calc_translational_bending_mass(double L, double Phi, double rho_A) {
  const double a = 70.0 * Phi * Phi + 147.0 * Phi + 78.0;
  const double b = (35.0 * Phi * Phi + 77.0 * Phi + 44.0) * L / 4.0;
  const double c = 35.0 * Phi * Phi + 63.0 * Phi + 27.0;
  const double d = (35.0 * Phi * Phi + 63.0 * Phi + 26.0) * L / 4.0;
  const double e = (7.0 * Phi * Phi + 14.0 * Phi + 8.0) * L * L / 4.0;
  const double f = (7.0 * Phi * Phi + 14.0 * Phi + 6.0) * L * L / 4.0;
  Eigen::Matrix4d matrix;
  matrix << a, b, c, -d,  //
      b, e, d, -f,        //
      c, d, a, -b,        //
      -d, -f, -b, e;
  return rho_A * L / (210.0 * (1.0 + Phi) * (1.0 + Phi)) * matrix;
}

// ρI ∫N_ψᵀ N_ψ dx (fem, eq. 12).
Eigen::Matrix4d calc_rotary_bending_mass(double L, double Phi, double rho_I) {
  const double a = 36.0;
  const double b = (15.0 * Phi - 3.0) * L;
  const double c = (10.0 * Phi * Phi + 5.0 * Phi + 4.0) * L * L;
  const double d = (5.0 * Phi * Phi - 5.0 * Phi - 1.0) * L * L;
  Eigen::Matrix4d matrix;
  matrix << a, -b, -a, -b,  //
      -b, c, b, d,          //
      -a, b, a, b,          //
      -b, d, b, c;
  return rho_I / (30.0 * (1.0 + Phi) * (1.0 + Phi) * L) * matrix;
}

}  // namespace

double calc_shear_parameter(double length, const BeamProperties& properties) {
  check_arguments(length, properties, "calc_shear_parameter");
  return 12.0 * properties.bending_rigidity / (properties.shear_rigidity * length * length);
}

Eigen::Matrix<double, 3, 6> calc_shape_functions(double length, const BeamProperties& properties, double xi) {
  if (!(xi >= 0.0 && xi <= 1.0)) {
    throw std::invalid_argument(fmt::format("calc_shape_functions: xi is {}, expected 0 … 1", xi));
  }
  const double L = length;
  const double Phi = calc_shear_parameter(length, properties);
  const double bar = 1.0 - xi;
  Eigen::Matrix<double, 3, 6> N = Eigen::Matrix<double, 3, 6>::Zero();
  N(0, 0) = bar;
  N(0, 3) = xi;
  N(1, 1) = bar * bar * (1.0 + 2.0 * xi) + Phi * bar;
  N(1, 2) = L * xi * bar * (bar + 0.5 * Phi);
  N(1, 4) = xi * xi * (3.0 - 2.0 * xi) + Phi * xi;
  N(1, 5) = -L * xi * bar * (xi + 0.5 * Phi);
  N(2, 1) = -6.0 / L * xi * bar;
  N(2, 2) = bar * (1.0 - 3.0 * xi + Phi);
  N(2, 4) = 6.0 / L * xi * bar;
  N(2, 5) = xi * (3.0 * xi - 2.0 + Phi);
  N.bottomRows<2>() /= 1.0 + Phi;
  return N;
}

Matrix6 calc_local_stiffness(double length, const BeamProperties& properties) {
  const double L = length;
  const double Phi = calc_shear_parameter(length, properties);
  if (properties.bushing) return calc_bushing_stiffness(*properties.bushing, L);
  const double axial = properties.axial_rigidity / L;
  Matrix6 K = Matrix6::Zero();
  K(0, 0) = K(3, 3) = axial;
  K(0, 3) = K(3, 0) = -axial;
  Eigen::Matrix4d bending;
  bending << 12.0, 6.0 * L, -12.0, 6.0 * L,                         //
      6.0 * L, (4.0 + Phi) * L * L, -6.0 * L, (2.0 - Phi) * L * L,  //
      -12.0, -6.0 * L, 12.0, -6.0 * L,                              //
      6.0 * L, (2.0 - Phi) * L * L, -6.0 * L, (4.0 + Phi) * L * L;
  add_bending(K, properties.bending_rigidity / ((1.0 + Phi) * L * L * L) * bending);
  return K;
}

Matrix6 calc_local_mass(double length, const BeamProperties& properties) {
  const double L = length;
  const double Phi = calc_shear_parameter(length, properties);
  const double axial = properties.mass_per_length * L / 6.0;
  Matrix6 M = Matrix6::Zero();
  M(0, 0) = M(3, 3) = 2.0 * axial;
  M(0, 3) = M(3, 0) = axial;
  add_bending(M, calc_translational_bending_mass(L, Phi, properties.mass_per_length));
  add_bending(M, calc_rotary_bending_mass(L, Phi, properties.rotary_inertia));
  return M;
}

double calc_length(const BeamElement& element) {
  const Eigen::Vector2d axis = element.second - element.first;
  return axis.norm();
}

Matrix6 calc_rotation(const BeamElement& element) {
  const double length = calc_length(element);
  check_arguments(length, element.properties, "calc_rotation");
  const Eigen::Vector2d t = (element.second - element.first) / length;
  Matrix6 T = Matrix6::Zero();
  for (const int end : {0, 3}) {
    T.block<2, 2>(end, end) << t.x(), t.y(), -t.y(), t.x();
    T(end + 2, end + 2) = 1.0;
  }
  return T;
}

Matrix6 calc_stiffness(const BeamElement& element) {
  const Matrix6 T = calc_rotation(element);
  return T.transpose() * calc_local_stiffness(calc_length(element), element.properties) * T;
}

Matrix6 calc_mass(const BeamElement& element) {
  const Matrix6 T = calc_rotation(element);
  return T.transpose() * calc_local_mass(calc_length(element), element.properties) * T;
}

Matrix6 calc_resultants(const BeamElement& element) {
  const Matrix6 T = calc_rotation(element);
  Matrix6 resultants = calc_local_stiffness(calc_length(element), element.properties) * T;
  resultants.topRows<3>() *= -1.0;  // the first end's outward normal is −x
  return resultants;
}

}  // namespace sprung::fem

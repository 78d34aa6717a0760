#include "fem/mesh_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sprung::fem {

namespace {

double calc_omega_squared(double frequency_hz) {
  return std::pow(2.0 * std::numbers::pi * frequency_hz, 2);
}

// The terms that fall with the fourth power and with the square of the length.
struct Terms {
  double fourth = 0.0, square = 0.0;
  double sum() const { return fourth + square; }
};

Terms calc_terms(double length, const BeamProperties& properties) {
  if (properties.bushing) return {};
  const double mass = properties.mass_per_length, L2 = length * length;
  const Terms bending{.fourth = mass * L2 * L2 / (1440.0 * properties.bending_rigidity),
                      .square = mass * L2 / (24.0 * properties.shear_rigidity)};
  const Terms axial{.square = mass * L2 / (24.0 * properties.axial_rigidity)};
  return axial.sum() > bending.sum() ? axial : bending;
}

double calc_error_of(const BeamModel& model, int element) {
  const BeamElement beam = make_element(model, element);
  return calc_error_per_omega_squared(calc_length(beam), beam.properties);
}

}  // namespace

double calc_error_per_omega_squared(double length, const BeamProperties& properties) {
  return calc_terms(length, properties).sum();
}

double MeshError::at(double frequency_hz) const {
  return per_omega_squared * calc_omega_squared(frequency_hz);
}

double MeshError::limit_hz() const {
  if (!(per_omega_squared > 0.0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(kCoarseMesh / per_omega_squared) / (2.0 * std::numbers::pi);
}

MeshError estimate_mesh_error(const BeamModel& model) {
  MeshError worst;
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const double error = calc_error_of(model, e);
    if (error > worst.per_omega_squared) worst = {.element = e, .per_omega_squared = error};
  }
  return worst;
}

int count_coarse_elements(const BeamModel& model, double frequency_hz) {
  const double most = kCoarseMesh / calc_omega_squared(frequency_hz);
  int number = 0;
  for (int e = 0; e < model.mesh.num_elements(); ++e) number += calc_error_of(model, e) > most ? 1 : 0;
  return number;
}

int calc_num_parts(const BeamModel& model, int element, double frequency_hz) {
  const double most = kCoarseMesh / calc_omega_squared(frequency_hz);
  const BeamElement beam = make_element(model, element);
  const Terms terms = calc_terms(calc_length(beam), beam.properties);
  if (terms.sum() <= most) return 1;
  // fourth / x² + square / x = most, x the square of the number
  const double half = 0.5 * terms.square / most;
  const double parts = std::ceil(std::sqrt(half + std::sqrt(half * half + terms.fourth / most)));
  return static_cast<int>(std::min(parts, 1e9));
}

}  // namespace sprung::fem

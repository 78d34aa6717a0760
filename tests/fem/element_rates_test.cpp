#include "fem/element_rates.h"

#include <cmath>
#include <functional>

#include "fem/assembly.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

BeamElement move(BeamElement element, const BeamElementRates& rates, double step) {
  element.first += step * rates.first;
  element.second += step * rates.second;
  element.properties.axial_rigidity += step * rates.properties.axial_rigidity;
  element.properties.bending_rigidity += step * rates.properties.bending_rigidity;
  element.properties.shear_rigidity += step * rates.properties.shear_rigidity;
  element.properties.mass_per_length += step * rates.properties.mass_per_length;
  element.properties.rotary_inertia += step * rates.properties.rotary_inertia;
  return element;
}

// Central differences with two steps, extrapolated: their error is of the fourth order.
Matrix6 calc_difference(const std::function<Matrix6(double)>& matrix) {
  const auto difference = [&](double h) -> Matrix6 { return (matrix(h) - matrix(-h)) / (2.0 * h); };
  return (4.0 * difference(5e-4) - difference(1e-3)) / 3.0;
}

}  // namespace

TEST_CASE("Rates of an element's matrices are what their differences tend to") {
  for (const BeamProperties& properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    const BeamElement element{.first = {0.3, -0.2}, .second = {0.9, 0.4}, .properties = properties};
    const auto& [EA, EI, kGA, rho_A, rho_I, area, section_modulus, bushing] = properties;
    const bool has_shear = !std::isinf(kGA);
    for (const BeamElementRates& rates :
         {BeamElementRates{.first = {0.3, 0.1}, .second = {-0.2, 0.25}},
          BeamElementRates{.properties = {.axial_rigidity = 0.7 * EA, .mass_per_length = 0.4 * rho_A}},
          BeamElementRates{.first = {0.1, 0.0},
          .properties = {.bending_rigidity = -0.6 * EI,
                        .shear_rigidity = has_shear ? 0.5 * kGA : 0.0,
                        .rotary_inertia = 0.3 * rho_I}}}) {
      const Matrix6 K = calc_difference([&](double h) { return calc_stiffness(move(element, rates, h)); });
      const Matrix6 M = calc_difference([&](double h) { return calc_mass(move(element, rates, h)); });
      CHECK((calc_stiffness_rate(element, rates) - K).norm() < 1e-9 * calc_stiffness(element).norm());
      CHECK((calc_mass_rate(element, rates) - M).norm() < 1e-9 * calc_mass(element).norm());
    }
  }
}

// A frame moved as a whole keeps its matrices.
TEST_CASE("Rates of a frame's matrices add up those of its elements and point masses") {
  BeamModel model = test::make_straight_beam({0.3, -0.2}, {1.9, 1.0}, 3, test::make_thick_properties());
  model.point_masses.push_back({.node = 1, .mass = 2.0, .inertia = 0.5});
  const Eigen::Index n = model.mesh.num_nodes();
  BeamModelRates rates{.node_positions = Eigen::Matrix2Xd::Ones(2, n),
                       .sections = {BeamPropertyRates{}},
                       .point_masses = {Eigen::Vector2d(3.0, 7.0)}};
  const AssembledMatrices moved = assemble_rates(model, rates);
  CHECK(moved.stiffness.norm() < 1e-12 * assemble(model).stiffness.norm());
  CHECK(Eigen::MatrixXd(moved.mass).diagonal().segment<3>(3).isApprox(Eigen::Vector3d(3.0, 3.0, 7.0), 1e-12));
  // All rigidities and masses in proportion: the matrices themselves.
  const auto& [EA, EI, kGA, rho_A, rho_I, area, section_modulus, bushing] = model.sections[0];
  rates.node_positions.setZero();
  rates.sections[0] = {.axial_rigidity = EA,
                       .bending_rigidity = EI,
                       .shear_rigidity = kGA,
                       .mass_per_length = rho_A,
                       .rotary_inertia = rho_I};
  rates.point_masses[0] << 2.0, 0.5;
  const AssembledMatrices whole = assemble(model), scaled = assemble_rates(model, rates);
  CHECK((scaled.stiffness - whole.stiffness).norm() < 1e-12 * whole.stiffness.norm());
  CHECK((scaled.mass - whole.mass).norm() < 1e-12 * whole.mass.norm());
}

}  // namespace sprung::fem

#include "fem/axial_force.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "fem/assembly.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tests/fem/rigid_motions.h"

namespace sprung::fem {

namespace {

constexpr double kSolution = 1e-10;  // relative, of static solutions whose matrix has a condition of 1e5

// Displacements of a frame held at node 0 under loads at its nodes.
Eigen::VectorXd solve_held(const BeamModel& model, const Eigen::VectorXd& load) {
  const Eigen::MatrixXd K = test::remove_node(assemble(model).stiffness, 0);
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(load.size());
  displacement.tail(load.size() - 3) = K.partialPivLu().solve(load.tail(load.size() - 3));
  return displacement;
}

}  // namespace

TEST_CASE("The inertia load of a frame is minus its mass times the acceleration of its nodes") {
  // Positions are linear along elements, so that consistent mass has the accelerations of a rigid body
  // exactly.
  const BeamModel model = test::make_general_frame();
  const Eigen::Vector2d origin(0.94, 1.37);
  const FrameAcceleration acceleration{.linear = {1.7, -2.3}, .angular = 0.9, .omega_squared = 3.1};
  const Eigen::MatrixXd rigid = test::calc_rigid_motions(model.mesh, origin);
  Eigen::VectorXd nodes = rigid * Eigen::Vector3d(1.7, -2.3, 0.9);
  for (int node = 0; node < model.mesh.num_nodes(); ++node) {
    nodes.segment<2>(3 * node) -= 3.1 * (model.mesh.node_positions.col(node) - origin);
  }
  const Eigen::VectorXd expected = -(assemble(model).mass * nodes);
  const Eigen::VectorXd load = calc_inertia_load(calc_mass_moments(model, origin), acceleration);
  CHECK(test::calc_difference(load, expected) < 1e-13);
}

TEST_CASE(
    "The axial force in a clamped beam that rotates about its root and falls is that of the mass beyond") {
  // By hand: N(s) = ρA [ω² (L² − s²)/2 − a_t (L − s)] + m [ω² L − a_t] with a point mass m at the end, for
  // any number of elements; none across the axis.
  const BeamProperties properties = test::make_thick_properties();
  const Eigen::Vector2d root(0.3, -0.2), end(1.9, 1.0), axis(0.8, 0.6);
  const double L = 2.0, m = 7.3, omega_squared = 5.0;
  const FrameAcceleration acceleration{.linear = {-1.1, 2.9}, .angular = 4.0, .omega_squared = omega_squared};
  const double along = axis.dot(acceleration.linear);
  for (const int num_elements : {1, 3}) {
    BeamModel model = test::make_straight_beam(root, end, num_elements, properties);
    model.point_masses = {{.node = num_elements, .mass = m, .inertia = 0.4}};
    const Eigen::VectorXd load = calc_inertia_load(calc_mass_moments(model, root), acceleration);
    const std::vector<AxialForce> forces =
        calc_axial_forces(model, solve_held(model, load), acceleration, root);
    for (int e = 0; e < num_elements; ++e) {
      for (const double xi : {0.0, 0.3, 1.0}) {
        const double s = L * (e + xi) / num_elements;
        const double expected =
            properties.mass_per_length * (omega_squared * (L * L - s * s) / 2.0 - along * (L - s)) +
            m * (omega_squared * L - along);
        CHECK(forces[static_cast<std::size_t>(e)].at(xi) == Approx(expected).epsilon(kSolution));
      }
    }
  }
}

TEST_CASE("Axial forces of a bent frame under loads at its end, by hand") {
  // An arm along x carries one along y: a force (F, G) at the end is the second's (shear, tension) and the
  // first's (tension, shear).
  BeamModel model = test::make_straight_beam({0.0, 0.0}, {1.3, 0.0}, 1, test::make_thin_properties());
  model.mesh.node_ids.push_back(3);
  model.mesh.node_positions.conservativeResize(2, 3);
  model.mesh.node_positions.col(2) << 1.3, 0.9;
  model.mesh.elements.push_back({1, 2, 0});
  Eigen::VectorXd load = Eigen::VectorXd::Zero(9);
  load.tail<3>() << 210.0, -340.0, 55.0;
  const std::vector<AxialForce> forces =
      calc_axial_forces(model, solve_held(model, load), {}, Eigen::Vector2d::Zero());
  CHECK(forces[0].at(0.4) == Approx(210.0).epsilon(kSolution));
  CHECK(forces[1].at(0.7) == Approx(-340.0).epsilon(kSolution));
  CHECK(forces[0].linear == 0.0);
  CHECK(forces[1].quadratic == 0.0);
}

TEST_CASE("A displacement vector of wrong size is refused") {
  const std::string message = test::message_of<std::invalid_argument>([] {
    calc_axial_forces(test::make_general_frame(), Eigen::VectorXd::Zero(12), {}, Eigen::Vector2d::Zero());
  });
  test::check_contains(message, "displacement has 12 values, expected 15");
}

}  // namespace sprung::fem

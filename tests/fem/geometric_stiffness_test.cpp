#include "fem/geometric_stiffness.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "fem/assembly.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

constexpr double kRounding = 1e-13;    // relative, of sums of a few dozen terms
constexpr double kQuadrature = 1e-12;  // relative, of quadrature points given to fifteen digits
constexpr double kLength = 0.7132;

// The lowest load factor at which K − load · K_G becomes singular: K_G of a unit compression.
double calc_buckling_load(const Eigen::MatrixXd& K, const Eigen::MatrixXd& K_G) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(-K_G, K);
  return 1.0 / solver.eigenvalues().maxCoeff();
}

// A clamped straight beam at an angle, under a unit compression at its end: K and K_G.
double calc_cantilever_buckling(int num_elements, const BeamProperties& properties) {
  const BeamModel model = test::make_straight_beam({0.3, -0.2}, {1.9, 1.0}, num_elements, properties);
  const std::vector<AxialForce> forces(model.mesh.elements.size(), {.constant = -1.0});
  return calc_buckling_load(test::remove_node(assemble(model).stiffness, 0),
                            test::remove_node(assemble_geometric_stiffness(model, forces), 0));
}

}  // namespace

// Expected: the stiffness by its own quadrature.
TEST_CASE("Scaled slopes give the geometric stiffness under a constant axial force") {
  for (const BeamProperties& properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    const BeamElement element{.first = {0.3, -0.2}, .second = {0.9, 0.7}, .properties = properties};
    const Eigen::Matrix<double, 4, 6> slopes = calc_scaled_slopes(element);
    const Matrix6 expected = calc_geometric_stiffness(element, {.constant = -2.5});
    CHECK(test::calc_difference(-2.5 * slopes.transpose() * slopes, expected) < kRounding);
  }
}

TEST_CASE("The slope is the derivative of the shape functions") {
  for (const BeamProperties& properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    for (const double xi : {0.1, 0.37, 0.82}) {
      // The central difference extrapolated from two steps is exact for cubics.
      const auto difference = [&](double h) -> Eigen::MatrixXd {
        return (calc_shape_functions(kLength, properties, xi + h) -
                calc_shape_functions(kLength, properties, xi - h))
                   .row(1) /
               (2.0 * h * kLength);
      };
      const Eigen::MatrixXd expected = (4.0 * difference(0.02) - difference(0.04)) / 3.0;
      CHECK(test::calc_difference(calc_slope(kLength, properties, xi), expected) < 1e-12);
    }
  }
}

TEST_CASE("Geometric stiffness under a constant force is the closed form of the Hermite beam") {
  // [Przemieniecki 1968], §15.2.
  const double N = 731.0, L = kLength;
  Matrix6 expected = Matrix6::Zero();
  Eigen::Matrix4d bending;
  bending << 36, 3 * L, -36, 3 * L,      //
      3 * L, 4 * L * L, -3 * L, -L * L,  //
      -36, -3 * L, 36, -3 * L,           //
      3 * L, -L * L, -3 * L, 4 * L * L;
  const std::vector<int> dofs{1, 2, 4, 5};
  expected(dofs, dofs) = N / (30.0 * L) * bending;
  const Matrix6 K = calc_local_geometric_stiffness(L, test::make_thin_properties(), {.constant = N});
  CHECK(test::calc_difference(K, expected) < kRounding);
}

TEST_CASE("Geometric stiffness is the integral of N w'² for forces that change along the element") {
  const AxialForce force{.constant = 210.0, .linear = -370.0, .quadratic = 95.0};
  for (const BeamProperties& properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    Matrix6 expected = Matrix6::Zero();
    for (const test::QuadraturePoint& point : test::make_quadrature()) {
      const Eigen::Matrix<double, 1, 6> slope = calc_slope(kLength, properties, point.xi);
      const double N = 210.0 - 370.0 * point.xi + 95.0 * point.xi * point.xi;
      expected += point.weight * kLength * N * slope.transpose() * slope;
    }
    const Matrix6 K = calc_local_geometric_stiffness(kLength, properties, force);
    CHECK(test::calc_difference(K, expected) < kQuadrature);
  }
}

TEST_CASE("The end forces of a stressed element turn with it, and do not change when it is moved") {
  // Turning by δ turns the tension N at the ends into N δ across; moments need none.
  const double N = -430.0;
  for (const BeamProperties& properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    const BeamElement element{.first = {0.371, -0.214}, .second = {1.142, 0.459}, .properties = properties};
    const Matrix6 K = calc_geometric_stiffness(element, {.constant = N});
    const Eigen::Vector2d first = element.first, second = element.second;
    Eigen::Matrix<double, 6, 3> motions;
    motions << 1, 0, -first.y(), 0, 1, first.x(), 0, 0, 1,  //
        1, 0, -second.y(), 0, 1, second.x(), 0, 0, 1;
    const Eigen::Vector2d axis = (second - first).normalized();
    const Eigen::Vector2d across(-axis.y(), axis.x());
    Eigen::Matrix<double, 6, 3> expected = Eigen::Matrix<double, 6, 3>::Zero();
    expected.block<2, 1>(0, 2) = -N * across;
    expected.block<2, 1>(3, 2) = N * across;
    CHECK((K * motions - expected).cwiseAbs().maxCoeff() < kRounding * std::abs(N));
    CHECK(test::calc_difference(K, K.transpose()) < kRounding);
  }
}

TEST_CASE("A clamped column buckles at Euler's load, from above and with the element's order") {
  // π²EI/4L² at L = 2 m; cubic elements converge with the fourth power of their length.
  const BeamProperties properties = test::make_thin_properties();
  const double euler = std::numbers::pi * std::numbers::pi * properties.bending_rigidity / 16.0;
  const double coarse = calc_cantilever_buckling(2, properties) / euler - 1.0;
  const double fine = calc_cantilever_buckling(4, properties) / euler - 1.0;
  CHECK(fine > 0.0);
  CHECK(fine < 1e-4);
  CHECK(std::log2(coarse / fine) == Approx(4.0).margin(0.1));
}

TEST_CASE("Shear lowers the buckling load by Engesser's formula") {
  // 1/P = 1/P_Euler + 1/κGA.
  BeamProperties properties = test::make_thick_properties();
  const double euler = std::numbers::pi * std::numbers::pi * properties.bending_rigidity / 16.0;
  const double expected = 1.0 / (1.0 / euler + 1.0 / properties.shear_rigidity);
  CHECK(expected < 0.99 * euler);
  CHECK(calc_cantilever_buckling(32, properties) == Approx(expected).epsilon(1e-4));
}

TEST_CASE("A frame's geometric stiffness needs one axial force for each element") {
  const BeamModel model = test::make_general_frame();
  const std::string message = test::message_of<std::invalid_argument>(
      [&] { assemble_geometric_stiffness(model, std::vector<AxialForce>(4)); });
  test::check_contains(message, "4 axial forces, expected one for each of 5 elements");
}

}  // namespace sprung::fem

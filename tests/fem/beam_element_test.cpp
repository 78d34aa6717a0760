#include "fem/beam_element.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fem/assembly.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

constexpr double kRounding = 1e-13;    // relative, of sums of a few dozen terms
constexpr double kQuadrature = 1e-12;  // relative, of quadrature points given to fifteen digits

using Shape = Eigen::Matrix<double, 3, 6>;
using Row6 = Eigen::Matrix<double, 1, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kLength = 0.7132;

BeamElement make_tilted_element(const BeamProperties& properties) {
  return {.first = {0.371, -0.214}, .second = {1.142, 0.459}, .properties = properties};
}

// d/dx of the shape functions: the central difference extrapolated from two steps is exact for cubics.
Shape calc_shape_derivatives(const BeamProperties& properties, double xi) {
  const auto difference = [&](double h) -> Shape {
    return (calc_shape_functions(kLength, properties, xi + h) -
            calc_shape_functions(kLength, properties, xi - h)) /
           (2.0 * h * kLength);
  };
  return (4.0 * difference(0.02) - difference(0.04)) / 3.0;
}

// Three rigid motions of an element with ends at x₁ and x₂, the rotation about (0.2, −0.7).
Eigen::Matrix<double, 6, 3> make_rigid_motions(const Eigen::Vector2d& first, const Eigen::Vector2d& second) {
  const Eigen::Vector2d origin(0.2, -0.7);
  Eigen::Matrix<double, 6, 3> R;
  R << 1, 0, -(first - origin).y(),  //
      0, 1, (first - origin).x(),    //
      0, 0, 1,                       //
      1, 0, -(second - origin).y(),  //
      0, 1, (second - origin).x(),   //
      0, 0, 1;
  return R;
}

}  // namespace

TEST_CASE("Shape functions take the nodal values at the nodes") {
  for (const BeamProperties& properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    const Shape first = calc_shape_functions(kLength, properties, 0.0);
    const Shape second = calc_shape_functions(kLength, properties, 1.0);
    CHECK(test::calc_difference(first.leftCols<3>(), Eigen::Matrix3d::Identity()) < kRounding);
    CHECK(first.rightCols<3>().isZero(kRounding));
    CHECK(second.leftCols<3>().isZero(kRounding));
    CHECK(test::calc_difference(second.rightCols<3>(), Eigen::Matrix3d::Identity()) < kRounding);
  }
}

TEST_CASE("Shape functions satisfy the beam's equations of equilibrium without load") {
  // EI ψ'' + κGA (w' − ψ) = 0 and κGA (w'' − ψ') = 0; of the Euler–Bernoulli beam ψ = w'
  const double h = 0.03;
  for (const double xi : {0.23, 0.5, 0.81}) {
    const BeamProperties thick = test::make_thick_properties();
    const Shape slope = calc_shape_derivatives(thick, xi);
    const Shape curvature =
        (calc_shape_derivatives(thick, xi + h) - calc_shape_derivatives(thick, xi - h)) / (2.0 * h * kLength);
    const Row6 shear =
        thick.shear_rigidity * (slope.row(1) - calc_shape_functions(kLength, thick, xi).row(2));
    const Row6 bending = thick.bending_rigidity * curvature.row(2);
    CHECK(test::calc_difference(-bending, shear) < 1e-9);  // second differences of rounding
    CHECK(test::calc_difference(curvature.row(1), slope.row(2)) < 1e-9);

    const BeamProperties thin = test::make_thin_properties();
    CHECK(test::calc_difference(calc_shape_functions(kLength, thin, xi).row(2),
                                calc_shape_derivatives(thin, xi).row(1)) < 1e-12);
  }
}

TEST_CASE("The stiffness is the quadrature of the shape functions' strains") {
  for (BeamProperties properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    Matrix6 K = Matrix6::Zero();
    for (const auto& [xi, weight] : test::make_quadrature()) {
      const double dx = weight * kLength;
      const Shape slope = calc_shape_derivatives(properties, xi);
      const Row6 shear = slope.row(1) - calc_shape_functions(kLength, properties, xi).row(2);
      K += dx * properties.axial_rigidity * slope.row(0).transpose() * slope.row(0);
      K += dx * properties.bending_rigidity * slope.row(2).transpose() * slope.row(2);
      if (std::isfinite(properties.shear_rigidity))
        K += dx * properties.shear_rigidity * shear.transpose() * shear;
    }
    CHECK(test::calc_difference(calc_local_stiffness(kLength, properties), K) <
          1e-11);  // differences of rounding
  }
}

TEST_CASE("The consistent mass is the quadrature of the shape functions") {
  BeamProperties thin_with_rotary = test::make_thin_properties();
  thin_with_rotary.rotary_inertia = 0.47;
  for (const BeamProperties& properties :
       {test::make_thick_properties(), test::make_thin_properties(), thin_with_rotary}) {
    Matrix6 M = Matrix6::Zero();
    for (const auto& [xi, weight] : test::make_quadrature()) {
      const Shape N = calc_shape_functions(kLength, properties, xi);
      M += weight * kLength * properties.mass_per_length * N.topRows<2>().transpose() * N.topRows<2>();
      M += weight * kLength * properties.rotary_inertia * N.row(2).transpose() * N.row(2);
    }
    CHECK(test::calc_difference(calc_local_mass(kLength, properties), M) < kQuadrature);
  }
}

TEST_CASE("The Euler-Bernoulli element is the textbook's") {
  // the textbook's matrices in closed form, with L = 2, EI = 3, EA = 5, ρA = 420/2
  const BeamProperties properties{.axial_rigidity = 5.0, .bending_rigidity = 3.0, .mass_per_length = 210.0};
  Matrix6 K, M;
  K << 2.5, 0, 0, -2.5, 0, 0,       //
      0, 4.5, 4.5, 0, -4.5, 4.5,    //
      0, 4.5, 6, 0, -4.5, 3,        //
      -2.5, 0, 0, 2.5, 0, 0,        //
      0, -4.5, -4.5, 0, 4.5, -4.5,  //
      0, 4.5, 3, 0, -4.5, 6;
  M << 140, 0, 0, 70, 0, 0,    //
      0, 156, 44, 0, 54, -26,  //
      0, 44, 16, 0, 26, -12,   //
      70, 0, 0, 140, 0, 0,     //
      0, 54, 26, 0, 156, -44,  //
      0, -26, -12, 0, -44, 16;
  CHECK(test::calc_difference(calc_local_stiffness(2.0, properties), K) < kRounding);
  CHECK(test::calc_difference(calc_local_mass(2.0, properties), M) < kRounding);
}

TEST_CASE("An element's rigid motions store no energy and carry its exact mass and inertia") {
  const BeamElement element = make_tilted_element(test::make_thick_properties());
  const Eigen::Matrix<double, 6, 3> R = make_rigid_motions(element.first, element.second);
  const Matrix6 K = calc_stiffness(element);
  CHECK((K * R).lpNorm<Eigen::Infinity>() < kRounding * K.lpNorm<Eigen::Infinity>());

  // by hand: mass ρA L; first moment about (0.2, −0.7); inertia ρA L³/12 + ρA L d² + ρI L
  const double L = std::hypot(0.771, 0.673);
  const double mass = 41.3 * L;
  const Eigen::Vector2d center(0.7565 - 0.2, 0.1225 + 0.7);
  const double inertia = mass * (L * L / 12.0 + center.squaredNorm()) + 0.83 * L;
  Eigen::Matrix3d expected;
  expected << mass, 0, -mass * center.y(),  //
      0, mass, mass * center.x(),           //
      -mass * center.y(), mass * center.x(), inertia;
  CHECK(test::calc_difference(R.transpose() * calc_mass(element) * R, expected) < kRounding);
}

TEST_CASE("An element has three zero modes only, and a positive mass") {
  const BeamElement element = make_tilted_element(test::make_thin_properties());
  const Eigen::SelfAdjointEigenSolver<Matrix6> stiffness(calc_stiffness(element));
  CHECK(std::abs(stiffness.eigenvalues()[2]) < 1e-12 * stiffness.eigenvalues()[5]);
  CHECK(stiffness.eigenvalues()[3] > 1e-6 * stiffness.eigenvalues()[5]);
  const Eigen::SelfAdjointEigenSolver<Matrix6> mass(calc_mass(element));
  CHECK(mass.eigenvalues()[0] > 0.0);
}

TEST_CASE("Resultants of constant strain, curvature and shear are exact at any angle") {
  const BeamProperties properties = test::make_thick_properties();
  const BeamElement element = make_tilted_element(properties);
  const double L = calc_length(element);
  const Matrix6 T = calc_rotation(element);
  const double strain = 1.3e-4, curvature = 2.1e-3, Q = 5.7e3;
  const double EI = properties.bending_rigidity;

  Vector6 own;
  own << 0, 0, 0, strain * L, 0, 0;
  Vector6 expected;
  expected << properties.axial_rigidity * strain, 0, 0, properties.axial_rigidity * strain, 0, 0;
  CHECK(test::calc_difference(calc_resultants(element) * T.transpose() * own, expected) < kRounding);

  // ψ = κx, w = κx²/2
  own << 0, 0, 0, 0, curvature * L * L / 2.0, curvature * L;
  expected << 0, 0, EI * curvature, 0, 0, EI * curvature;
  CHECK(test::calc_difference(calc_resultants(element) * T.transpose() * own, expected) < kRounding);

  // Q = −M' constant, M(L) = 0: M = Q (L − x), ψ = Q (Lx − x²/2)/EI, w = Q (Lx²/2 − x³/6)/EI + Qx/κGA
  own << 0, 0, 0, 0, Q * L * L * L / (3.0 * EI) + Q * L / properties.shear_rigidity, Q * L * L / (2.0 * EI);
  expected << 0, Q, Q * L, 0, Q, 0;
  CHECK(test::calc_difference(calc_resultants(element) * T.transpose() * own, expected) < kRounding);
}

TEST_CASE("Resultants do not depend on rigid motion, and change sign as stated when the ends are swapped") {
  const BeamElement element = make_tilted_element(test::make_thick_properties());
  const BeamElement swapped{
      .first = element.second, .second = element.first, .properties = element.properties};
  Vector6 q;
  q << 1.1e-3, -2.3e-3, 0.7e-3, 3.1e-3, 0.4e-3, -1.9e-3;
  const Vector6 resultants = calc_resultants(element) * q;
  const Vector6 moved = calc_resultants(element) * (q + make_rigid_motions(element.first, element.second) *
                                                            Eigen::Vector3d(3e-3, -5e-3, 2e-3));
  CHECK(test::calc_difference(moved, resultants) < 1e-12);

  // seen from the other side x and y are turned by 180°: N and Q stay, M changes sign
  Vector6 q_swapped, expected;
  q_swapped << q.tail<3>(), q.head<3>();
  expected << resultants[3], resultants[4], -resultants[5], resultants[0], resultants[1], -resultants[2];
  CHECK(test::calc_difference(calc_resultants(swapped) * q_swapped, expected) < kRounding);
}

TEST_CASE("A patch of unequal elements reproduces constant strain, curvature and shear at any angle") {
  BeamModel model = test::make_straight_beam({0.3, -0.2}, {2.1, 1.4}, 3, test::make_thick_properties());
  const Eigen::Vector2d from(0.3, -0.2), along = Eigen::Vector2d(1.8, 1.6).normalized();
  const double L = std::hypot(1.8, 1.6);
  const double place[] = {0.0, 0.21 * L, 0.68 * L, L};
  for (int node = 0; node < 4; ++node) model.mesh.node_positions.col(node) = from + place[node] * along;
  const Eigen::MatrixXd K = assemble(model).stiffness;

  const double strain = 1.7e-4, curvature = 1.1e-3, Q = 3.3e3;
  const double EI = model.sections[0].bending_rigidity, kGA = model.sections[0].shear_rigidity;
  Eigen::VectorXd q(12);
  for (int node = 0; node < 4; ++node) {
    const double x = place[node];
    const double u = strain * x;
    const double w = curvature * x * x / 2.0 + Q * (L * x * x / 2.0 - x * x * x / 6.0) / EI + Q * x / kGA;
    const double psi = curvature * x + Q * (L * x - x * x / 2.0) / EI;
    q.segment<2>(3 * node) = u * along + w * Eigen::Vector2d(-along.y(), along.x());
    q[3 * node + 2] = psi;
  }
  const Eigen::VectorXd force = K * q;
  const double scale = K.lpNorm<Eigen::Infinity>() * q.lpNorm<Eigen::Infinity>();
  CHECK(force.segment<6>(3).lpNorm<Eigen::Infinity>() < kRounding * scale);
  // at the far end: N along, Q across, and the moment EI κ
  const Eigen::Vector2d end =
      model.sections[0].axial_rigidity * strain * along + Q * Eigen::Vector2d(-along.y(), along.x());
  const Eigen::Vector2d error = force.segment<2>(9) - end;
  CHECK(error.norm() < kRounding * scale);
  CHECK(std::abs(force[11] - EI * curvature) < kRounding * scale);
}

TEST_CASE("A cantilever's tip deflects by the textbook's value with any number of elements") {
  const double P = 4.1e3, L = std::hypot(1.8, 1.6);
  const Eigen::Vector2d across(-1.6 / L, 1.8 / L);
  for (const BeamProperties& properties : {test::make_thick_properties(), test::make_thin_properties()}) {
    for (const int num_elements : {1, 3}) {
      const BeamModel model = test::make_straight_beam({0.3, -0.2}, {2.1, 1.4}, num_elements, properties);
      const Eigen::MatrixXd K = test::remove_node(assemble(model).stiffness, 0);
      Eigen::VectorXd force = Eigen::VectorXd::Zero(K.rows());
      force.segment<2>(K.rows() - 3) = P * across;
      const Eigen::VectorXd q = K.llt().solve(force);
      const double deflection = q.segment<2>(K.rows() - 3).dot(across);
      const double expected =
          P * L * L * L / (3.0 * properties.bending_rigidity) + P * L / properties.shear_rigidity;
      CHECK(deflection == Approx(expected).epsilon(1e-10));  // condition number 1e4 … 1e5
      CHECK(q[K.rows() - 1] == Approx(P * L * L / (2.0 * properties.bending_rigidity)).epsilon(1e-10));
    }
  }
}

TEST_CASE("Stiff in shear, the element tends to the Euler-Bernoulli element") {
  BeamProperties nearly = test::make_thin_properties();
  nearly.shear_rigidity = 1e12 * nearly.bending_rigidity;
  CHECK(test::calc_difference(calc_local_stiffness(kLength, nearly),
                              calc_local_stiffness(kLength, test::make_thin_properties())) < 1e-9);
}

TEST_CASE("Arguments out of range are refused with name and value") {
  const BeamProperties good = test::make_thick_properties();
  const auto message = [&](double BeamProperties::*member, double value) {
    BeamProperties properties = good;
    properties.*member = value;
    return test::message_of<std::invalid_argument>([&] { calc_local_stiffness(1.0, properties); });
  };
  const double infinity = std::numeric_limits<double>::infinity();
  test::check_contains(message(&BeamProperties::axial_rigidity, 0.0),
                       "axial_rigidity is 0, expected a finite value > 0 N");
  test::check_contains(message(&BeamProperties::bending_rigidity, infinity), "bending_rigidity is inf");
  test::check_contains(message(&BeamProperties::shear_rigidity, -1.0),
                       "shear_rigidity is -1, expected a value > 0 N or infinity");
  test::check_contains(message(&BeamProperties::mass_per_length, -2.0), "mass_per_length is -2");
  test::check_contains(message(&BeamProperties::rotary_inertia, std::nan("")), "rotary_inertia is nan");
  test::check_contains(message(&BeamProperties::area, -1.0), "area is -1, expected a finite value ≥ 0 m²");
  test::check_contains(message(&BeamProperties::section_modulus, infinity), "section_modulus is inf");
  test::check_contains(test::message_of<std::invalid_argument>([&] { calc_local_mass(0.0, good); }),
                       "length is 0 m");
  test::check_contains(test::message_of<std::invalid_argument>([&] { calc_shape_functions(1.0, good, 1.1); }),
                       "xi is 1.1, expected 0 … 1");
  const BeamElement element{.first = {1.0, 2.0}, .second = {1.0, 2.0}, .properties = good};
  test::check_contains(test::message_of<std::invalid_argument>([&] { calc_stiffness(element); }),
                       "length is 0 m");
}

}  // namespace sprung::fem

// The effect of axial forces on bending, against d'Alembert's loads of the moving body and against
// differences.
#include "dynamics/bodies/stiffening.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include "dynamics/bodies/body_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/momentum.h"
#include "tests/dynamics/random_numbers.h"

using namespace sprung;
using dynamics::Body;
using dynamics::BodyStiffening;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr int kNumModes = 4;
constexpr double kRounding = 1e-12;  // relative, of sums of a few dozen terms

// A crooked frame with arbitrary geometric stiffness: the tested relations hold for any.
struct Case {
  test::RandomNumbers random{21};
  reduce::Superelement superelement =
      test::make_beam_superelement(test::make_crooked_frame(), kNumModes).superelement;
  std::vector<int> columns{0, 1, 3};
  Body body;

  MatrixXd make_symmetric() {
    MatrixXd matrix(kNumModes, kNumModes);
    for (Index k = 0; k < kNumModes; ++k) matrix.col(k) = random.vector(kNumModes, 1.0);
    return matrix + matrix.transpose();
  }
  Case() {
    reduce::GeometricStiffness geometric{
        make_symmetric(), make_symmetric(), {make_symmetric(), make_symmetric()}, {}};
    for (std::size_t i = 0; i < superelement.points.size(); ++i) {
      geometric.point_loads.push_back({make_symmetric(), make_symmetric(), make_symmetric()});
    }
    superelement.geometric_stiffness = geometric;
    body = dynamics::make_flexible_body("frame", superelement, {1, 2, 4}, dynamics::Stiffening::kOn);
  }
  const BodyStiffening& stiffening() const { return *body.stiffening; }
  MatrixXd active(const MatrixXd& matrix) const { return matrix(columns, columns); }
};

}  // namespace

TEST_CASE("In quasi-static motion a body stiffens as under its loads and d'Alembert's", "[bodies]") {
  // Forces and moments on the named nodes and ω² give the frame of the undeformed body the accelerations a
  // and α by Newton's and Euler's laws; the sum of all reference loads must then be what the points' K and
  // K_ω have.
  Case general;
  const reduce::GeometricStiffness& reference = *general.superelement.geometric_stiffness;
  const reduce::InertiaInvariants& inertia = general.superelement.inertia;
  const double omega_squared = 3.7;
  Vector3d resultant(omega_squared * inertia.first_moment.x(), omega_squared * inertia.first_moment.y(), 0.0);
  MatrixXd expected = omega_squared * general.active(reference.centrifugal);
  MatrixXd found = omega_squared * general.stiffening().centrifugal;
  for (std::size_t i = 0; i < general.superelement.points.size(); ++i) {
    const Vector3d load = general.random.vector(3, 50.0);
    const Vector2d r = general.superelement.node_positions.col(general.superelement.points[i].node);
    resultant += Vector3d(load.x(), load.y(), load[2] + r.x() * load.y() - r.y() * load.x());
    const dynamics::SecondOrder K = dynamics::calc_second_order(
        general.superelement, general.columns, general.stiffening(), static_cast<int>(i), Vector2d::Zero());
    for (std::size_t c = 0; c < 3; ++c) {
      expected += load[static_cast<Index>(c)] * general.active(reference.point_loads[i][c]);
      found += load[static_cast<Index>(c)] * K[c];
    }
  }
  Eigen::Matrix3d mass;
  const Vector2d s = inertia.first_moment;
  mass << inertia.mass, 0.0, -s.y(), 0.0, inertia.mass, s.x(), -s.y(), s.x(), inertia.second_moment;
  const Vector3d acceleration = mass.inverse() * resultant;
  expected += acceleration[0] * general.active(reference.acceleration[0]) +
              acceleration[1] * general.active(reference.acceleration[1]) +
              acceleration[2] * general.active(reference.angular_acceleration);
  CHECK((found - expected).norm() < kRounding * expected.norm());
}

TEST_CASE("An offset point moves on a circle about its node: second order of the offset by finite rotation",
          "[bodies]") {
  Case general;
  const Vector2d offset(0.3, -0.2);
  const dynamics::SecondOrder node = dynamics::calc_second_order(general.superelement, general.columns,
                                                                 general.stiffening(), 1, Vector2d::Zero());
  const dynamics::SecondOrder point =
      dynamics::calc_second_order(general.superelement, general.columns, general.stiffening(), 1, offset);
  const int row = 3 * general.superelement.points[1].node + 2;
  const VectorXd direction = general.random.vector(3, 1.0);
  // Second derivative of the turned offset along η = s · direction at s = 0, by differences: error s²,
  // rounding 1e-16/s².
  const auto turned_offset = [&](double s) -> Vector2d {
    const VectorXd eta = s * direction;
    const double psi = general.superelement.shapes(row, general.columns).dot(eta.transpose()) -
                       dynamics::calc_half_form(node, eta)[2];
    return dynamics::FrameRotation::from_angle(psi) * offset;
  };
  constexpr double kStep = 1e-4;
  const Vector2d curvature =
      (turned_offset(kStep) - 2.0 * turned_offset(0.0) + turned_offset(-kStep)) / (kStep * kStep);
  const Vector3d difference =
      dynamics::calc_half_form(point, direction) - dynamics::calc_half_form(node, direction);
  CHECK((difference.head<2>() + 0.5 * curvature).norm() < 1e-6 * curvature.norm());
  CHECK(std::abs(difference[2]) < kRounding);
}

TEST_CASE("The mean rotation is that of the angular momentum about the centre of mass", "[bodies]") {
  Case general;
  VectorXd q = VectorXd::Zero(6), v = general.random.vector(6, 2.0);
  const reduce::InertiaInvariants& inertia = general.superelement.inertia;
  const Vector2d center = inertia.first_moment / inertia.mass;
  const test::Momentum momentum = test::calc_momentum(general.body, q, v);
  const double about_center =
      momentum.angular - center.x() * momentum.linear.y() + center.y() * momentum.linear.x();
  const double central = inertia.second_moment - inertia.mass * center.squaredNorm();
  CHECK(v[2] + general.stiffening().mean_rotation.dot(v.tail(3)) ==
        Approx(about_center / central).epsilon(kRounding));
}

TEST_CASE("Centrifugal stiffening does no work, and at steady rotation is −ω² K_ω η", "[bodies]") {
  Case general;
  const VectorXd eta = general.random.vector(3, 1.0), eta_dot = general.random.vector(3, 4.0);
  VectorXd Q = VectorXd::Zero(6), v = VectorXd::Zero(6);
  v[2] = 2.9;
  v.tail(3) = eta_dot;
  dynamics::add_stiffening_forces(general.stiffening(), v[2], eta, eta_dot, Q);
  CHECK(std::abs(Q.dot(v)) < kRounding * Q.norm() * v.norm());
  CHECK(Q.norm() > 0.1);
  Q.setZero();
  dynamics::add_stiffening_forces(general.stiffening(), 2.9, eta, VectorXd::Zero(3), Q);
  CHECK((Q.tail(3) + 2.9 * 2.9 * general.stiffening().centrifugal * eta).norm() < kRounding * Q.norm());
  CHECK(Q.head<3>().norm() == 0.0);
}

TEST_CASE("A body without modes does not stiffen; one without geometric stiffness cannot", "[bodies]") {
  Case general;
  using dynamics::Stiffening;
  CHECK_FALSE(dynamics::make_flexible_body("frame", general.superelement, {}, Stiffening::kOn).stiffening);
  CHECK_FALSE(dynamics::make_flexible_body("frame", general.superelement, {1}).stiffening);
  general.superelement.geometric_stiffness.reset();
  CHECK_THROWS_WITH(
      dynamics::make_flexible_body("frame", general.superelement, {1, 3}, Stiffening::kOn),
      "make_flexible_body: superelement 'crooked' has the geometric stiffness of 0 modes, got mode 3");
}

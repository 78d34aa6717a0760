// Mass matrix, quadratic velocity forces, weight and momentum of a flexible body against sums over the points
// of its mass, which do not use the invariants. The body is a crooked frame, so that no invariant vanishes.
#include "dynamics/bodies/body_equations.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "dynamics/bodies/body_forces.h"
#include "dynamics/bodies/body_mass.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/momentum.h"
#include "tests/dynamics/random_numbers.h"

using namespace sprung;
using dynamics::Body;
using dynamics::FrameRotation;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

constexpr int kNumModes = 6;

// r = R + A(θ)(u₀ + φη) and its derivatives, written out with angles.
struct PointMotion {
  double dm;
  Vector2d r, v, a_bias;
  MatrixXd J;  // 2×(3+n)

  PointMotion(const test::MassPoint& point, const VectorXd& q, const VectorXd& v_q) : dm(point.dm) {
    const Index n = point.shape.cols();
    Eigen::Matrix2d A, A_theta;
    A << std::cos(q[2]), -std::sin(q[2]), std::sin(q[2]), std::cos(q[2]);
    A_theta << -std::sin(q[2]), -std::cos(q[2]), std::cos(q[2]), -std::sin(q[2]);
    const Vector2d u = point.r + point.shape * q.tail(n);
    const Vector2d u_dot = point.shape * v_q.tail(n);
    r = q.head<2>() + A * u;
    J.resize(2, 3 + n);
    J << Eigen::Matrix2d::Identity(), A_theta * u, A * point.shape;
    v = J * v_q;
    a_bias = 2.0 * v_q[2] * (A_theta * u_dot) - v_q[2] * v_q[2] * (A * u);
  }
};

struct Case {
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), kNumModes);
  Body body = dynamics::make_flexible_body("frame", frame.superelement, {1, 2, 3, 4, 5, 6});
  VectorXd q, v;

  // Bent by up to a metre or so, turning fast: no term is small.
  explicit Case(std::uint64_t seed) {
    test::RandomNumbers random(seed);
    q = random.vector(3 + kNumModes, 3.0);
    v = random.vector(3 + kNumModes, 5.0);
    for (Index k = 0; k < kNumModes; ++k) {
      q[3 + k] *= 0.3 / body.mode_scale[k];
      v[3 + k] *= 1.0 / body.mode_scale[k];
    }
  }

  MatrixXd mass(const VectorXd& at) const {
    dynamics::BodyMass mass(body);
    mass.update(FrameRotation::from_angle(at[2]), at.tail(kNumModes));
    return mass.matrix();
  }
  // The forces without stiffness and damping of the modes.
  VectorXd forces(const VectorXd& velocity, const Vector2d& gravity) const {
    Body loose = body;
    loose.stiffness.setZero();
    loose.damping.setZero();
    const FrameRotation rotation = FrameRotation::from_angle(q[2]);
    dynamics::BodyMass mass(loose);
    mass.update(rotation, q.tail(kNumModes));
    VectorXd Q = VectorXd::Zero(3 + kNumModes);
    dynamics::BodyForces(loose).add(mass, rotation, gravity, q.data(), velocity.data(), Q.data());
    return Q;
  }
  VectorXd quadratic_velocity_forces() const { return forces(v, Vector2d::Zero()); }
};

constexpr double kRounding = 1e-12;  // relative, of sums over 20 points

}  // namespace

TEST_CASE("The crooked frame has no invariant that vanishes", "[bodies]") {
  const Body body = Case(1).body;
  CHECK(body.first_moment.cwiseAbs().minCoeff() > 1.0);
  CHECK(body.P.cwiseAbs().minCoeff() > 0.01);
  CHECK(body.c.cwiseAbs().minCoeff() > 0.01);
  CHECK(body.d.cwiseAbs().minCoeff() > 0.01);
  CHECK(body.B.cwiseAbs().maxCoeff() > 0.1);
}

TEST_CASE("The mass matrix is the sum over the body's points", "[bodies]") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Case general(seed);
    MatrixXd expected = MatrixXd::Zero(3 + kNumModes, 3 + kNumModes);
    for (const test::MassPoint& point : general.frame.points) {
      const PointMotion motion(point, general.q, general.v);
      expected += motion.dm * motion.J.transpose() * motion.J;
    }
    CHECK((general.mass(general.q) - expected).norm() < kRounding * expected.norm());
  }
}

TEST_CASE("The quadratic velocity forces are minus the sum of the points' inertia at zero accelerations",
          "[bodies]") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Case general(seed);
    VectorXd expected = VectorXd::Zero(3 + kNumModes);
    for (const test::MassPoint& point : general.frame.points) {
      const PointMotion motion(point, general.q, general.v);
      expected -= motion.dm * motion.J.transpose() * motion.a_bias;
    }
    CHECK((general.quadratic_velocity_forces() - expected).norm() < kRounding * expected.norm());
  }
}

TEST_CASE("The quadratic velocity forces are what Lagrange's equations leave of the mass matrix",
          "[bodies]") {
  // Q_v = −d/dt(M v) + ∂T/∂q at constant v, by central differences: error of the order h² of a motion with
  // unit times
  const Case general(3);
  constexpr double kStep = 1e-5;
  const VectorXd& q = general.q;
  const VectorXd& v = general.v;
  VectorXd expected = -(general.mass(q + kStep * v) - general.mass(q - kStep * v)) * v / (2.0 * kStep);
  for (Index i = 0; i < q.size(); ++i) {
    const VectorXd e = VectorXd::Unit(q.size(), i);
    expected[i] +=
        0.5 * v.dot((general.mass(q + kStep * e) - general.mass(q - kStep * e)) * v) / (2.0 * kStep);
  }
  CHECK((general.quadratic_velocity_forces() - expected).norm() < 1e-7 * expected.norm());
}

TEST_CASE("The weight is the sum over the body's points, in any direction of gravity", "[bodies]") {
  const Case general(4);
  const Vector2d gravity(2.5, -9.1);
  VectorXd expected = VectorXd::Zero(3 + kNumModes);
  for (const test::MassPoint& point : general.frame.points) {
    const PointMotion motion(point, general.q, general.v);
    expected += motion.dm * motion.J.transpose() * gravity;
  }
  const VectorXd at_rest = VectorXd::Zero(3 + kNumModes);
  CHECK((general.forces(at_rest, gravity) - expected).norm() < kRounding * expected.norm());
}

TEST_CASE("Stiffness and damping act on the modes alone, whether they are diagonal or not", "[bodies]") {
  // The differences from a body without them are −K η and −C η̇; the power is η̇ᵀC η̇.
  for (const double coupling : {0.0, 0.3}) {
    Case general(7);
    Body& body = general.body;
    body.damping = VectorXd::LinSpaced(kNumModes, 1.0, 4.0).asDiagonal();
    body.damping(1, 4) = body.damping(4, 1) = body.stiffness(0, 2) = body.stiffness(2, 0) = coupling;
    const FrameRotation rotation = FrameRotation::from_angle(general.q[2]);
    dynamics::BodyMass mass(body);
    mass.update(rotation, general.q.tail(kNumModes));
    VectorXd Q = -general.quadratic_velocity_forces();
    const double power = dynamics::BodyForces(body).add(mass, rotation, Vector2d::Zero(), general.q.data(),
                                                        general.v.data(), Q.data());
    const VectorXd eta = general.q.tail(kNumModes), eta_dot = general.v.tail(kNumModes);
    const VectorXd expected = -body.stiffness * eta - body.damping * eta_dot;
    const double size = general.quadratic_velocity_forces().norm() + expected.norm();
    CHECK(Q.head<3>().norm() < kRounding * size);
    CHECK((Q.tail(kNumModes) - expected).norm() < kRounding * size);
    CHECK(power == Approx(eta_dot.dot(body.damping * eta_dot)).epsilon(kRounding));
  }
}

TEST_CASE("Momentum and angular momentum are sums over the body's points", "[bodies]") {
  const Case general(5);
  Vector2d linear = Vector2d::Zero(), moment = Vector2d::Zero();
  double angular = 0.0;
  for (const test::MassPoint& point : general.frame.points) {
    const PointMotion motion(point, general.q, general.v);
    linear += motion.dm * motion.v;
    angular += motion.dm * (motion.r.x() * motion.v.y() - motion.r.y() * motion.v.x());
    moment += motion.dm * (point.r + point.shape * general.q.tail(kNumModes));
  }
  const test::Momentum momentum = test::calc_momentum(general.body, general.q, general.v);
  CHECK((momentum.linear - linear).norm() < kRounding * linear.norm());
  CHECK(std::abs(momentum.angular - angular) < kRounding * std::abs(angular));
  CHECK((dynamics::calc_first_moment(general.body, general.q.tail(kNumModes)) - moment).norm() <
        kRounding * moment.norm());
}

TEST_CASE("Rotary inertia of a point turns with frame and mode and gives no centrifugal force", "[bodies]") {
  // A disc of inertia I on a point whose rotation is ψη: T gains ½ I (θ̇ + ψη̇)², which depends on no position.
  const Case plain(6);
  Case with_disc(6);
  constexpr double kInertia = 40.0;
  const Eigen::RowVectorXd psi = test::RandomNumbers(8).vector(kNumModes, 1.0).transpose();
  with_disc.body.second_moment += kInertia;
  with_disc.body.c += kInertia * psi;
  with_disc.body.M_ff += kInertia * psi.transpose() * psi;  // M_tt stays
  VectorXd turning = VectorXd::Zero(3 + kNumModes);
  turning << 0.0, 0.0, 1.0, psi.transpose();
  const MatrixXd expected = plain.mass(plain.q) + kInertia * turning * turning.transpose();
  CHECK((with_disc.mass(with_disc.q) - expected).norm() < kRounding * expected.norm());
  CHECK(with_disc.quadratic_velocity_forces() == plain.quadratic_velocity_forces());
}

TEST_CASE("A quarter turn and back", "[bodies]") {
  const FrameRotation rotation = FrameRotation::from_angle(0.7);
  const Vector2d p(1.3, -0.4);
  CHECK((rotation * p -
         Vector2d(std::cos(0.7) * 1.3 + std::sin(0.7) * 0.4, std::sin(0.7) * 1.3 - std::cos(0.7) * 0.4))
            .norm() < 1e-15);
  CHECK((rotation.transposed_times(rotation * p) - p).norm() < 1e-15);
  CHECK(dynamics::turned(p) == Vector2d(0.4, 1.3));
}

TEST_CASE("A nearby rotation has the sine and cosine of its angle, wherever it is asked for", "[bodies]") {
  dynamics::NearbyRotation nearby;
  test::RandomNumbers random(5);
  double theta = 0.4;
  double largest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    theta += random.size_up_to(i % 100 == 0 ? 3.0 : 0.01);  // mostly near, now and then far
    const FrameRotation rotation = nearby.at(theta);
    largest = std::max(
        {largest, std::abs(rotation.cosine - std::cos(theta)), std::abs(rotation.sine - std::sin(theta))});
  }
  CHECK(largest < 3e-16);  // one and a half units in the last place of 1
  CHECK(std::isnan(nearby.at(std::numeric_limits<double>::quiet_NaN()).cosine));
  CHECK(nearby.at(1.0).sine == std::sin(1.0));
}

// Motion of a point of a flexible body against differences of its position along the body's motion.
#include "dynamics/bodies/marker.h"

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::FrameRotation;
using dynamics::MarkerState;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

struct Case {
  dynamics::Model model;
  VectorXd q, v, a;
  Vector2d offset{0.2, -0.35};
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 4);

  explicit Case(bool second_order = false) {
    const int body =
        test::add_body(model, dynamics::make_flexible_body("frame", frame.superelement, {1, 2, 4}));
    test::add_node_marker(model, body, frame.superelement, 2, offset);
    test::RandomNumbers random(11);
    q = random.vector(6, 1.0);
    v = random.vector(6, 2.0);
    a = random.vector(6, 4.0);
    if (!second_order) return;
    for (Eigen::MatrixXd& K : model.markers[0].K) {
      K.resize(3, 3);
      for (Index k = 0; k < 3; ++k) K.col(k) = random.vector(3, 0.7);
      K = (K + K.transpose()).eval();
    }
  }
  const dynamics::Marker& marker() const { return model.markers[0]; }
  MarkerState state(const VectorXd& at, const VectorXd& rate) const {
    MarkerState result = dynamics::make_marker_state(marker());
    const FrameRotation rotation = FrameRotation::from_angle(at[2]);
    dynamics::calc_marker_position(marker(), rotation, at.data(), result);
    dynamics::calc_marker_velocity(marker(), rate.data(), result);
    return result;
  }
  // Along q(t) = q + v t + ½ a t².
  MarkerState state_at(double t) const { return state(q + v * t + 0.5 * a * t * t, v + a * t); }
};

constexpr double kStep = 1e-5;       // s
constexpr double kTolerance = 1e-8;  // of central differences with that step: error h² and rounding 1e-16/h

}  // namespace

TEST_CASE("A marker on a node follows the node's motion and rotation", "[bodies]") {
  const Case general;
  // By hand: node position + displacement, the offset turned by the node's small rotation.
  Eigen::Vector3d shape = Eigen::Vector3d::Zero();
  for (const auto& [mode, k] : {std::pair{1, 0}, {2, 1}, {4, 2}}) {
    shape += general.frame.superelement.shapes.block<3, 1>(3 * 2, mode - 1) * general.q[3 + k];
  }
  const Vector2d node = general.frame.superelement.node_positions.col(2);
  const Vector2d u = node + shape.head<2>() + general.offset + shape[2] * Vector2d(0.35, 0.2);
  const double c = std::cos(general.q[2]), s = std::sin(general.q[2]);
  const Vector2d expected = general.q.head<2>() + Vector2d(c * u.x() - s * u.y(), s * u.x() + c * u.y());
  const MarkerState state = general.state_at(0.0);
  CHECK((state.r - expected).norm() < 1e-14);
  CHECK(state.angle == Approx(general.q[2] + shape[2]).epsilon(1e-14));
}

TEST_CASE("Velocity and acceleration of a marker are derivatives of its position", "[bodies]") {
  for (const bool second_order : {false, true}) {
    const Case general(second_order);
    const MarkerState now = general.state_at(0.0), before = general.state_at(-kStep),
                      after = general.state_at(kStep);
    CHECK((now.v - (after.r - before.r) / (2.0 * kStep)).norm() < kTolerance * now.v.norm());
    CHECK(std::abs(now.omega - (after.angle - before.angle) / (2.0 * kStep)) <
          kTolerance * std::abs(now.omega));
    const Vector2d acceleration = dynamics::calc_marker_acceleration(now, general.a);
    CHECK((acceleration - (after.v - before.v) / (2.0 * kStep)).norm() < kTolerance * acceleration.norm());
    const double angular = now.alpha_bias + general.a[2] + now.Phi.row(2).dot(general.a.tail(3));
    CHECK(std::abs(angular - (after.omega - before.omega) / (2.0 * kStep)) < kTolerance * std::abs(angular));
  }
}

TEST_CASE("Gradients of a marker's position and angle by angle and modes", "[bodies]") {
  for (const bool second_order : {false, true}) {
    const Case general(second_order);
    const MarkerState now = general.state_at(0.0);
    for (Index i = 2; i < 6; ++i) {
      const VectorXd e = kStep * VectorXd::Unit(6, i);
      const MarkerState above = general.state(general.q + e, general.v),
                        below = general.state(general.q - e, general.v);
      const Vector2d difference = (above.r - below.r) / (2.0 * kStep);
      const Vector2d gradient = i == 2 ? now.r_theta : Vector2d(now.r_eta().col(i - 3));
      CHECK((gradient - difference).norm() < kTolerance * (gradient.norm() + 0.01));
      const double turn = i == 2 ? 1.0 : now.Phi(2, i - 3);
      CHECK(std::abs(turn - (above.angle - below.angle) / (2.0 * kStep)) <
            kTolerance * (std::abs(turn) + 0.01));
    }
  }
}

TEST_CASE("The deflection of a marker is its position in the body less the undeformed one", "[bodies]") {
  for (const bool second_order : {false, true}) {
    const Case general(second_order);
    const MarkerState now = general.state_at(0.0);
    const Vector2d u = FrameRotation::from_angle(general.q[2]).transposed_times(now.r - general.q.head<2>());
    const Vector2d expected = u - general.marker().p_BP;
    CHECK((dynamics::calc_marker_deflection(general.marker(), general.q.tail(3)) - expected).norm() < 1e-14);
  }
}

// Mechanisms that make full turns in absolute coordinates. No single partition is regular all the way, so the
// solver must change it without a jump. Exact solutions are known.
#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "dynamics/linear/assembly.h"
#include "dynamics/simulation/transient.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Model;
using dynamics::SteppingMethod;
using Eigen::Vector2d;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

constexpr double kGravity = 9.81, kArm = 0.9, kLength = 1.0;

struct Motion {
  std::vector<double> time;
  std::vector<VectorXd> q, v;
  dynamics::TransientStatistics statistics;
  double largest_energy_change = 0.0, largest_violation = 0.0;
};

Motion run(const Model& model, const VectorXd& q, const VectorXd& v, double end_time, double output_step,
           double tolerance, SteppingMethod method = SteppingMethod::kAdams) {
  Motion motion;
  double energy = 0.0;
  dynamics::TransientOptions options;
  options.end_time = end_time;
  options.output_step = output_step;
  options.integrator = {.method = method, .relative_tolerance = tolerance};
  options.on_output = [&](const dynamics::Snapshot& snapshot) {
    motion.time.push_back(snapshot.time);
    motion.q.push_back(snapshot.q);
    motion.v.push_back(snapshot.v);
    const double total = snapshot.energy.stored.total();
    if (motion.time.size() == 1) energy = total;
    motion.largest_energy_change = std::max(motion.largest_energy_change, std::abs(total - energy));
    VectorXd phi(model.num_constraints);
    snapshot.terms().calc_residual(phi);
    motion.largest_violation = std::max(motion.largest_violation, phi.cwiseAbs().maxCoeff());
  };
  motion.statistics = dynamics::run_transient(model, test::make_state(model, q, v), options);
  return motion;
}

// The bob, at the pendulum's equivalent length from the pivot.
Vector2d bob(const VectorXd& q) {
  return kLength * Vector2d(std::cos(q[2]), std::sin(q[2]));
}

Eigen::Vector3d turning(double angle, double rate) {
  return rate * Eigen::Vector3d(-kArm * std::sin(angle), kArm * std::cos(angle), 1.0);
}

}  // namespace

TEST_CASE("The pendulum released horizontally follows the exact solution through its changes of partition",
          "[analysis]") {
  const Model model = test::make_pendulum(1.0, kArm, kLength, kGravity);
  const Eigen::Vector3d start = test::place_pendulum(kArm, 0.0);
  // Jacobi's elliptic functions at t = 10 s: a point of 1 kg at 1 m, which the bar with this inertia swings
  // like
  const Vector2d exact(0.2750874625761, -0.9614192050991);
  double last_error = 1.0;
  for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    const Motion motion = run(model, start, VectorXd::Zero(3), 10.0, 0.01, tolerance);
    const double error = (bob(motion.q.back()) - exact).norm();
    INFO("tolerance " << tolerance << ", error " << error);
    CHECK(motion.time.back() == 10.0);
    CHECK(error < 30.0 * tolerance);
    CHECK(error < last_error);
    CHECK(motion.largest_violation < 1e-9);
    last_error = error;
  }
}

TEST_CASE("The pendulum's period is the exact one", "[analysis]") {
  const Model model = test::make_pendulum(1.0, kArm, kLength, kGravity);
  const double period = 2.3678419475762373;  // 4 K(sin(π/4)) √(l/g)
  const Motion motion =
      run(model, test::place_pendulum(kArm, 0.0), VectorXd::Zero(3), 4.0 * period, period / 8.0, 1e-10);
  for (std::size_t i = 0; i + 8 < motion.q.size(); ++i) {
    CHECK((motion.q[i + 8] - motion.q[i]).norm() < 1e-8);
    CHECK((motion.v[i + 8] - motion.v[i]).norm() < 1e-7);
  }
  // Half a period later it hangs on the other side
  CHECK(motion.q[4][2] == Approx(-pi).margin(1e-8));
}

TEST_CASE("A pendulum that makes full turns keeps its period while its partition changes", "[analysis]") {
  const Model model = test::make_pendulum(1.0, kArm, kLength, kGravity);
  const double bottom_rate = 8.0;  // above 2√(g/l) = 6.26 rad/s: it goes over the top
  // [Landau & Lifshitz 1976], §11: T = 2 k K(k)/√(g/l) for one turn, k = 2√(g/l)/rate
  const double k = 2.0 * std::sqrt(kGravity / kLength) / bottom_rate;
  const double turn = 2.0 * k * std::comp_ellint_1(k) / std::sqrt(kGravity / kLength);
  for (const auto method : {SteppingMethod::kAdams, SteppingMethod::kBdf, SteppingMethod::kExponential}) {
    const Motion motion = run(model, test::place_pendulum(kArm, -0.5 * pi), turning(-0.5 * pi, bottom_rate),
                              10.0 * turn, turn / 20.0, 1e-9, method);
    CHECK(motion.statistics.stepper.repartitions >= 10);
    CHECK(motion.q.back()[2] == Approx(-0.5 * pi + 20.0 * pi).margin(1e-6));
    CHECK((motion.v.back() - motion.v.front()).norm() < 1e-5);
    CHECK(motion.largest_energy_change < 1e-6);
    CHECK(motion.largest_violation < 1e-9);
    // No jump anywhere: each turn repeats the first, shifted by 2π
    for (std::size_t i = 0; i + 20 < motion.q.size(); ++i) {
      Eigen::Vector3d once_round = motion.q[i + 20] - motion.q[i];
      once_round[2] -= 2.0 * pi;
      CHECK(once_round.norm() < 1e-6);
    }
  }
}

TEST_CASE("The energy book continues through changes of partition", "[analysis]") {
  // A damper from the bob to a point beside the circle slows the pendulum while it goes round.
  Model model = test::make_pendulum(1.0, kArm, kLength, kGravity);
  test::add_spring(model, "damper", model.find_marker("bar.bob"),
                   test::add_marker(model, dynamics::kGround, {1.7, 0.4}), 1.0, 5.0, 0.3);
  dynamics::number_model(model);
  const dynamics::State start =
      test::make_state(model, test::place_pendulum(kArm, -0.5 * pi), turning(-0.5 * pi, 14.0));
  double first = 0.0, dissipated = 0.0, largest_error = 0.0, least_growth = 0.0;
  dynamics::TransientOptions options;
  options.end_time = 3.0;
  options.integrator.relative_tolerance = 1e-8;
  options.on_output = [&](const dynamics::Snapshot& snapshot) {
    const dynamics::EnergyBook& book = snapshot.energy;
    if (snapshot.time == 0.0) first = book.stored.total();
    least_growth = std::min(least_growth, book.dissipated - dissipated);
    dissipated = book.dissipated;
    largest_error = std::max(largest_error, std::abs(book.stored.total() - first + dissipated - book.input));
  };
  const dynamics::TransientStatistics statistics = dynamics::run_transient(model, start, options);
  CHECK(statistics.stepper.repartitions >= 5);
  CHECK(dissipated > 10.0);  // J, of 90 J that it starts with
  CHECK(largest_error < 1e-5);
  CHECK(least_growth > -1e-6);
}

namespace {

// Crank, coupler and rocker between posts 0.9 m apart; the crank can turn right round (Grashof: 0.4 + 1.0 <
// 0.8 + 0.9).
constexpr double kCrank = 0.4, kCoupler = 1.0, kRocker = 0.8, kPosts = 0.9;
constexpr double kBarMass[] = {2.0, 3.0, 1.5}, kBarInertia[] = {0.05, 0.3, 0.1};

Model make_crank_rocker() {
  Model model;
  const double length[] = {kCrank, kCoupler, kRocker};
  const char* names[] = {"crank", "coupler", "rocker"};
  for (int i = 0; i < 3; ++i)
    test::add_body(model, dynamics::make_rigid_body(names[i], kBarMass[i], kBarInertia[i]));
  const auto end = [&](int body, double side) {
    return test::add_marker(model, body, {0.5 * side * length[body], 0.0});
  };
  test::add_pin(model, "crank_post", test::add_marker(model, dynamics::kGround, {0.0, 0.0}), end(0, -1.0));
  test::add_pin(model, "crank_pin", end(0, 1.0), end(1, -1.0));
  test::add_pin(model, "rocker_pin", end(1, 1.0), end(2, 1.0));
  test::add_pin(model, "rocker_post", test::add_marker(model, dynamics::kGround, {kPosts, 0.0}),
                end(2, -1.0));
  dynamics::number_model(model);
  return model;
}

// Positions of the linkage at a crank angle, by the law of cosines, with the pin of the rocker above.
VectorXd place_crank_rocker(double crank_angle) {
  const Vector2d pin = kCrank * Vector2d(std::cos(crank_angle), std::sin(crank_angle)), post(kPosts, 0.0);
  const Vector2d base = post - pin;
  const double distance = base.norm();
  const double corner = std::acos((kCoupler * kCoupler + distance * distance - kRocker * kRocker) /
                                  (2.0 * kCoupler * distance));
  const double coupler_angle = std::atan2(base.y(), base.x()) + corner;
  const Vector2d top = pin + kCoupler * Vector2d(std::cos(coupler_angle), std::sin(coupler_angle));
  const double rocker_angle = std::atan2(top.y() - post.y(), top.x() - post.x());
  VectorXd q(9);
  q << 0.5 * pin, crank_angle, 0.5 * (pin + top), coupler_angle, 0.5 * (post + top), rocker_angle;
  return q;
}

// ∂q/∂(crank angle), by differences of fourth order of the closed form.
VectorXd crank_directions(double angle) {
  constexpr double h = 1e-3;
  return (8.0 * (place_crank_rocker(angle + h) - place_crank_rocker(angle - h)) -
          (place_crank_rocker(angle + 2.0 * h) - place_crank_rocker(angle - 2.0 * h))) /
         (12.0 * h);
}

double crank_inertia(double angle) {
  const VectorXd d = crank_directions(angle);
  double inertia = 0.0;
  for (int i = 0; i < 3; ++i) {
    inertia += kBarMass[i] * d.segment<2>(3 * i).squaredNorm() + kBarInertia[i] * d[3 * i + 2] * d[3 * i + 2];
  }
  return inertia;
}

}  // namespace

TEST_CASE("A closed chain turning fully takes the time that its energy and inertia give it", "[analysis]") {
  // Without forces ½ I(φ) φ̇² stays: one turn of the crank takes ∮ √(I(φ)/2E) dφ. The integrand is periodic,
  // so the trapezium rule converges faster than any power.
  const Model model = make_crank_rocker();
  const double rate = 7.0, start_angle = 0.3;
  const double energy = 0.5 * crank_inertia(start_angle) * rate * rate;
  double turn = 0.0;
  constexpr int kPoints = 720;
  for (int i = 0; i < kPoints; ++i) {
    turn += std::sqrt(crank_inertia(2.0 * pi * i / kPoints) / (2.0 * energy)) * 2.0 * pi / kPoints;
  }
  VectorXd q = place_crank_rocker(start_angle);
  REQUIRE(dynamics::assemble_positions(model, q).largest_movement < 1e-12);
  VectorXd v = rate * crank_directions(start_angle);
  dynamics::project_velocities(model, 0.0, q, v);
  const Motion motion = run(model, q, v, 5.0 * turn, turn / 50.0, 1e-10);
  CHECK(motion.statistics.stepper.repartitions >= 5);
  CHECK(motion.q.back()[2] == Approx(start_angle + 10.0 * pi).margin(1e-6));
  CHECK(motion.largest_energy_change < 1e-7 * energy);
  CHECK(motion.largest_violation < 1e-9);
  for (std::size_t i = 0; i < motion.q.size(); i += 7) {
    VectorXd expected = place_crank_rocker(motion.q[i][2]);
    CHECK((motion.q[i] - expected).norm() < 1e-9);
  }
}

TEST_CASE("Mechanisms move alike after many turns, or far from the origin", "[analysis]") {
  // Coordinates are rounded more coarsely there, and joints can be closed no better. The angle becomes a
  // dependent one on the way.
  const Model model = test::make_pendulum(1.0, kArm, kLength, kGravity);
  const Model far = [] {
    Model moved = test::make_pendulum(1.0, kArm, kLength, kGravity);
    for (dynamics::Marker& marker : moved.markers) {
      if (marker.body == dynamics::kGround) marker.p_BP += Vector2d(1e5, -3e5);
    }
    dynamics::number_model(moved);
    return moved;
  }();
  const Eigen::Vector3d start = test::place_pendulum(kArm, 0.0);
  const Eigen::Vector3d turned = start + Eigen::Vector3d(0.0, 0.0, 2.0 * pi * 160e3);
  const Eigen::Vector3d away = start + Eigen::Vector3d(1e5, -3e5, 0.0);
  using Method = SteppingMethod;
  for (const Method method : {Method::kExponential, Method::kAdams, Method::kBdf}) {
    INFO("method " << static_cast<int>(method));
    const auto fall = [&](const Model& of, const Eigen::Vector3d& from) {
      return bob(run(of, from, VectorXd::Zero(3), 3.0, 0.5, 1e-5, method).q.back());
    };
    const Vector2d expected = fall(model, start);
    CHECK((fall(model, turned) - expected).norm() < 1e-4);
    CHECK((fall(far, away) - expected).norm() < 1e-4);
  }
}

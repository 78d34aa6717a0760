// The partitioned equations on small mechanisms: against the plain evaluator where every invariant of a
// flexible body counts, and against hand calculations. The truck's are in truck_equations_test.cpp.
#include "dynamics/system/partitioned_equations.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "dynamics/linear/assembly.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/chains.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/small_models.h"
#include "tests/dynamics/system/dense_comparison.h"

using namespace sprung;
using dynamics::Model;
using dynamics::PartitionedEquations;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

// Ground – crooked frame – rigid bar – crooked frame with other modes: pins on nodes, one beside a node; a
// spring with damper from a node to the ground.
struct Chain {
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 8);
  Model model;

  Chain() {
    model.gravity = {1.5, -9.0};
    const reduce::Superelement& s = frame.superelement;
    const int first = test::add_body(model, dynamics::make_flexible_body("first", s, {1, 2, 3, 5, 8}));
    const int bar = test::add_body(model, dynamics::make_rigid_body("bar", 12.0, 3.0));
    const int last = test::add_body(model, dynamics::make_flexible_body("last", s, {2, 4}));
    test::add_pin(model, "post", test::add_marker(model, dynamics::kGround, {0.3, 0.2}),
                  test::add_node_marker(model, first, s, 2));
    test::add_pin(model, "middle", test::add_node_marker(model, first, s, 4, {0.1, -0.2}),
                  test::add_marker(model, bar, {0.0, 0.4}));
    test::add_pin(model, "end", test::add_marker(model, bar, {0.2, -0.3}),
                  test::add_node_marker(model, last, s, 1));
    test::add_spring(model, "spring", test::add_node_marker(model, last, s, 3, {0.3, 0.1}),
                     test::add_marker(model, dynamics::kGround, {-2.0, 1.0}), 1.2, 8e3, 50.0);
    dynamics::number_model(model);
  }
};

}  // namespace

TEST_CASE("Positions of another model are refused", "[system]") {
  const Chain chain;
  PartitionedEquations equations(chain.model);
  const VectorXd q = VectorXd::Zero(chain.model.num_coordinates - 1);
  CHECK_THROWS_AS(equations.choose_partition_at(0.0, q), std::invalid_argument);
}

TEST_CASE("Fast and plain evaluator agree on a chain of crooked flexible bodies in any position",
          "[system]") {
  const Chain chain;
  test::RandomNumbers random(99);
  double worst = 0.0;
  int num_compared = 0;
  for (int i = 0; i < 200; ++i) {
    // Any angles and bent shapes; then the origins follow from the joints, one after the other.
    VectorXd assembled = random.vector(chain.model.num_coordinates, 3.0);
    for (const dynamics::Body& body : chain.model.bodies) {
      for (Eigen::Index k = 0; k < body.num_modes(); ++k) {
        assembled[body.first_coordinate + 3 + k] *= 0.1 / body.mode_scale[k];
      }
    }
    dynamics::SystemTerms terms(chain.model);
    VectorXd phi(chain.model.num_constraints);
    for (Eigen::Index joint = 0; joint < 3; ++joint) {
      terms.update_positions(0.0, assembled);
      terms.calc_residual(phi);
      const Vector2d gap = phi.segment<2>(2 * joint);  // r_a − r_b: move the body of b
      assembled.segment<2>(chain.model.bodies[static_cast<std::size_t>(joint)].first_coordinate) += gap;
    }
    const VectorXd change = random.vector(chain.model.num_coordinates, 0.02);
    const VectorXd v = random.vector(chain.model.num_coordinates, 4.0);
    dynamics::State state;
    const test::EvaluatorDifference difference =
        test::compare_evaluators(chain.model, assembled, assembled + change, v, state);
    worst = std::max(worst, difference.largest());
    CHECK(((state.q.array() != 0.0).all() && (state.v.array() != 0.0).all()));
    ++num_compared;
  }
  CHECK(num_compared == 200);
  CHECK(worst < 1e-9);
}

TEST_CASE("The multipliers of two hanging bars are the weights below each joint", "[system]") {
  // φ = r_a − r_b, φ_qᵀλ = Q at rest: λ is the force with which a presses on b, so minus what holds a.
  Model model;
  model.gravity = {0.0, -9.81};
  const int upper = test::add_body(model, dynamics::make_rigid_body("upper", 3.0, 0.2));
  const int lower = test::add_body(model, dynamics::make_rigid_body("lower", 5.0, 0.4));
  test::add_pin(model, "top", test::add_marker(model, upper, {0.0, 0.5}),
                test::add_marker(model, dynamics::kGround, {0.0, 0.0}));
  test::add_pin(model, "knee", test::add_marker(model, lower, {0.0, 1.0}),
                test::add_marker(model, upper, {0.0, -0.5}));
  dynamics::number_model(model);
  VectorXd q(6);
  q << 0.0, -0.5, 0.0, 0.0, -2.0, 0.0;
  PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  std::vector<double> q_i, v_i(2, 0.0);
  for (const int i : equations.partition().independent) q_i.push_back(q[i]);
  REQUIRE(equations.update_positions(0.0, q_i) == PartitionedEquations::Outcome::kGood);
  equations.update_velocities(v_i);
  REQUIRE(equations.update_accelerations({}) == PartitionedEquations::Outcome::kGood);
  CHECK(equations.v_dot().norm() < 1e-12);
  const VectorXd& lambda = equations.multipliers();
  CHECK(lambda[0] == Approx(0.0).margin(1e-11));
  CHECK(lambda[1] == Approx(-8.0 * 9.81).epsilon(1e-12));
  CHECK(lambda[2] == Approx(0.0).margin(1e-11));
  CHECK(lambda[3] == Approx(-5.0 * 9.81).epsilon(1e-12));
}

TEST_CASE("The accelerations satisfy the equations that they solve", "[system]") {
  // Residuals as the oracle: M v̇ + φ_qᵀλ − Q = 0, φ_q v = 0, and φ̈ = 0 by differences of φ̇ along the motion.
  const Chain chain;
  PartitionedEquations equations(chain.model);
  test::RandomNumbers random(17);
  VectorXd q = random.vector(chain.model.num_coordinates, 0.3);
  dynamics::SystemTerms terms(chain.model);
  VectorXd phi(chain.model.num_constraints);
  for (Eigen::Index joint = 0; joint < 3; ++joint) {
    terms.update_positions(0.0, q);
    terms.calc_residual(phi);
    q.segment<2>(chain.model.bodies[static_cast<std::size_t>(joint)].first_coordinate) +=
        phi.segment<2>(2 * joint);
  }
  equations.choose_partition_at(0.0, q);
  std::vector<double> q_i, v_i;
  for (const int i : equations.partition().independent) {
    q_i.push_back(q[i]);
    v_i.push_back(random.size_up_to(2.0));
  }
  REQUIRE(equations.update_positions(0.0, q_i) == PartitionedEquations::Outcome::kGood);
  equations.update_velocities(v_i);
  std::vector<int> branches(static_cast<std::size_t>(chain.model.num_branches));
  equations.terms().choose_branches(branches);
  REQUIRE(equations.update_accelerations(branches) == PartitionedEquations::Outcome::kGood);

  VectorXd residual =
      equations.terms().jacobian().dense().transpose() * equations.multipliers() - equations.terms().forces();
  for (std::size_t b = 0; b < chain.model.bodies.size(); ++b) {
    const dynamics::Body& body = chain.model.bodies[b];
    residual.segment(body.first_coordinate, body.num_coordinates()) +=
        equations.terms().mass(b) * equations.v_dot().segment(body.first_coordinate, body.num_coordinates());
  }
  CHECK(residual.norm() < 1e-11 * equations.terms().forces().norm());
  CHECK((equations.terms().jacobian().dense() * equations.v()).norm() < 1e-12 * equations.v().norm());

  constexpr double kStep = 1e-6;  // s
  const auto phi_rate_at = [&](double t) {
    dynamics::SystemTerms moved(chain.model);
    moved.update_positions(0.0, equations.q() + t * equations.v() + 0.5 * t * t * equations.v_dot());
    moved.update_jacobian();
    return VectorXd(moved.jacobian().dense() * (equations.v() + t * equations.v_dot()));
  };
  const VectorXd phi_acceleration = (phi_rate_at(kStep) - phi_rate_at(-kStep)) / (2.0 * kStep);
  CHECK(phi_acceleration.norm() < 1e-6 * equations.v_dot().norm());
}

TEST_CASE("Positions that cannot be reached are reported, and the next evaluation is sound again",
          "[system]") {
  const Model model = test::make_pendulum(1.0, 0.8, 1.0, 9.81);
  PartitionedEquations equations(model);
  const Eigen::Vector3d start = test::place_pendulum(0.8, -0.3);
  equations.choose_partition_at(0.0, start);
  REQUIRE(equations.partition().independent.size() == 1);
  const int independent = equations.partition().independent[0];
  REQUIRE(independent < 2);  // x or y of the centre, which a circle of 0.8 m bounds
  std::vector<double> value{start[independent]};
  const std::vector<double> out_of_reach{5.0}, nan{std::numeric_limits<double>::quiet_NaN()};
  CHECK(equations.update_positions(0.0, out_of_reach) == PartitionedEquations::Outcome::kNotAssembled);
  CHECK(equations.update_positions(0.0, nan) == PartitionedEquations::Outcome::kNotFinite);
  REQUIRE(equations.update_positions(0.0, value) == PartitionedEquations::Outcome::kGood);
  CHECK((equations.q() - start).norm() < 1e-12);
}

TEST_CASE("A search for positions that ends in NaN leaves the equations usable", "[system]") {
  const Chain chain;
  PartitionedEquations equations(chain.model);
  VectorXd q = VectorXd::Zero(chain.model.num_coordinates);
  dynamics::assemble_positions(chain.model, q);
  equations.choose_partition_at(0.0, q);
  const std::vector<int>& independent = equations.partition().independent;
  std::vector<double> start, far;
  for (const int i : independent) start.push_back(q[i]);
  far.assign(start.size(), 1e308);
  CHECK(equations.update_positions(0.0, far) == PartitionedEquations::Outcome::kNotAssembled);
  REQUIRE(equations.update_positions(0.0, start) == PartitionedEquations::Outcome::kGood);
  CHECK(equations.q().allFinite());
  equations.update_velocities(std::vector<double>(start.size(), 0.0));
  std::vector<int> branches(static_cast<std::size_t>(chain.model.num_branches));
  equations.terms().choose_branches(branches);
  CHECK(equations.update_accelerations(branches) == PartitionedEquations::Outcome::kGood);
  // Nor do accelerations that are NaN.
  equations.update_velocities(std::vector<double>(start.size(), 1e200));
  CHECK(equations.update_accelerations(branches) == PartitionedEquations::Outcome::kNotFinite);
  REQUIRE(equations.update_positions(1e-3, start) == PartitionedEquations::Outcome::kGood);
  CHECK(equations.q().allFinite());
}

TEST_CASE("The quality of a partition decreases towards the position where it is singular", "[system]") {
  const Model model = test::make_pendulum(1.0, 0.8, 1.0, 9.81);
  PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, test::place_pendulum(0.8, -0.8));
  const int independent = equations.partition().independent[0];
  REQUIRE(independent < 2);
  CHECK(equations.partition_decay() <= 1.0 + 1e-12);
  // Towards where the centre moves across the independent coordinate: x at angle 0, y at angle −π/2
  const double singular = independent == 0 ? 0.0 : -0.5 * std::numbers::pi;
  double last = 1.0;
  for (const double distance : {0.5, 0.2, 0.05, 0.01}) {
    const double angle = singular + (singular < -0.8 ? distance : -distance);
    const std::vector<double> value{test::place_pendulum(0.8, angle)[independent]};
    REQUIRE(equations.update_positions(0.0, value) == PartitionedEquations::Outcome::kGood);
    CHECK(equations.partition_decay() > last);
    last = equations.partition_decay();
  }
  CHECK(last > 20.0);
}

TEST_CASE("What moves with a freedom at some position is found from the joints", "[system]") {
  for (const bool closed : {false, true}) {
    const test::Chain chain = closed ? test::make_closed_chain(12) : test::make_open_chain(12);
    PartitionedEquations equations(chain.model);
    equations.choose_partition_at(0.0, chain.state.q);
    const Eigen::MatrixXd pattern = equations.find_pattern_of_directions();
    // Whatever D has at positions nearby, in which no link is parallel to another or to an axis.
    Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(pattern.rows(), pattern.cols());
    for (const double shift : {0.01, 0.02}) {
      std::vector<double> values;
      for (const int i : equations.partition().independent)
        values.push_back(chain.state.q[i] + shift * std::sin(2.0 + i));
      REQUIRE(equations.update_positions(0.0, values) == PartitionedEquations::Outcome::kGood);
      seen = seen.cwiseMax((equations.calc_directions().array() != 0.0).cast<double>().matrix());
    }
    CHECK(pattern == seen);
    CHECK(pattern.isOnes() == false);
  }
}

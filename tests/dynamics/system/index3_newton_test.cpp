// Newton's equations of the index-3 system: against differences of the residual itself.
#include "dynamics/system/index3_newton.h"

#include <Eigen/Core>
#include <Eigen/SVD>
#include <memory>
#include <vector>

#include "dynamics/forces/bushing.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::ConstrainedMotion;
using dynamics::Index3Newton;
using dynamics::Index3Residual;
using dynamics::Model;
using Eigen::VectorXd;

namespace {

// Crooked frames hanging on one another, with a spring and damper from each to the one after the next.
struct Chain {
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 5);
  Model model;
  std::vector<int> branches;

  explicit Chain(int num_links) {
    model.gravity = {1.5, -9.0};
    const reduce::Superelement& s = frame.superelement;
    int above = test::add_marker(model, dynamics::kGround, {0.3, 0.2});
    std::vector<int> ends;
    for (int i = 0; i < num_links; ++i) {
      const std::vector<int> modes = i % 2 == 0 ? std::vector<int>{1, 2, 4} : std::vector<int>{};
      const int link = test::add_body(model, dynamics::make_flexible_body("link", s, modes));
      test::add_pin(model, "pin", above, test::add_node_marker(model, link, s, 2));
      above = test::add_node_marker(model, link, s, 4, {0.1, -0.2});
      ends.push_back(test::add_node_marker(model, link, s, 3));
      if (i % 3 == 2) add_mount(ends[static_cast<std::size_t>(i - 1)], ends.back());
      if (i >= 2)
        test::add_spring(model, "spring", ends[static_cast<std::size_t>(i - 2)], ends.back(), 0.4, 3e3, 50.0);
    }
    dynamics::number_model(model);
    branches.resize(static_cast<std::size_t>(model.num_branches));
  }

  // With two internal states.
  void add_mount(int marker_a, int marker_b) {
    dynamics::Bushing::Parameters mount{.marker_a = marker_a, .marker_b = marker_b};
    mount.directions[0] = {.relaxing_stiffness = 2e3, .relaxation_time = 0.02};
    mount.directions[2] = {.relaxing_stiffness = 50.0, .relaxation_time = 0.1};
    model.forces.push_back(std::make_unique<dynamics::Bushing>("mount", mount));
  }
};

ConstrainedMotion any_motion(const Model& model) {
  test::RandomNumbers random(7);
  ConstrainedMotion motion(model);
  motion.q = random.vector(model.num_coordinates, 0.3);
  motion.v = random.vector(model.num_coordinates, 2.0);
  motion.v_dot = random.vector(model.num_coordinates, 20.0);
  motion.lambda = random.vector(model.num_constraints, 300.0);
  return motion;
}

}  // namespace

TEST_CASE("Newton's equations return the change from which the residual was made, dense and sparse",
          "[system]") {
  for (const int num_links : {3, 20}) {  // 23 and 200 unknowns: both ways of factorising
    const Chain chain(num_links);
    const Model& model = chain.model;
    const ConstrainedMotion motion = any_motion(model);
    Index3Residual residual(model);
    Index3Newton newton(model);
    newton.linearise(residual, motion, chain.branches);
    const Index3Newton::Weights weights{.acceleration = 1.2, .velocity = 6e-3, .position = 3e-5};
    REQUIRE(newton.factorise(residual.terms(), weights));
    const VectorXd force = residual.force(), phi = residual.phi();

    test::RandomNumbers random(23);
    const double size = 1e-3;
    const VectorXd delta = random.vector(model.num_coordinates, size);
    const VectorXd delta_lambda = random.vector(model.num_constraints, size);
    ConstrainedMotion moved = motion;
    moved.q += weights.position * delta;
    moved.v += weights.velocity * delta;
    moved.v_dot += weights.acceleration * delta;
    moved.lambda += delta_lambda;
    residual.update(moved, chain.branches);
    VectorXd found = delta, found_lambda = delta_lambda;
    newton.solve(residual.force() - force, (residual.phi() - phi) / weights.position, found, found_lambda);
    INFO(num_links << " links");
    CHECK((found + delta).cwiseAbs().maxCoeff() < 1e-4 * size);
    CHECK((found_lambda + delta_lambda).cwiseAbs().maxCoeff() < 1e-3 * size);

    moved = motion;
    moved.q += weights.position * delta;
    moved.v += weights.velocity * delta;
    residual.update(moved, chain.branches);
    const VectorXd expected = residual.force() - force;
    VectorXd change = expected;
    newton.calc_force_change(delta, change);
    CHECK((change - expected).norm() < 1e-4 * expected.norm());
  }
}

TEST_CASE("The number of differences for Newton's equations does not grow with the length of a chain",
          "[system]") {
  const auto num_differences = [](int num_links) {
    const Chain chain(num_links);
    Index3Residual residual(chain.model);
    Index3Newton newton(chain.model);
    newton.linearise(residual, any_motion(chain.model), chain.branches);
    return residual.num_updates();
  };
  CHECK(num_differences(40) == num_differences(20));
  CHECK(num_differences(20) < 2 + 2 * 20 * 3);
}

TEST_CASE("The condition of Newton's equations has a limit for short steps", "[system]") {
  const Chain chain(4);
  Index3Residual residual(chain.model);
  Index3Newton newton(chain.model);
  newton.linearise(residual, any_motion(chain.model), chain.branches);
  const auto condition = [&](double length) {
    REQUIRE(newton.factorise(residual.terms(), {1.2, 0.6 * length, 0.3 * length * length}));
    const VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(newton.dense()).singularValues();
    return values[0] / values[values.size() - 1];
  };
  const double limit = condition(1e-9);
  CHECK(limit < 1e4);
  CHECK(condition(1e-5) == Approx(limit).epsilon(0.05));
  CHECK(condition(1e-7) == Approx(limit).epsilon(1e-3));
}

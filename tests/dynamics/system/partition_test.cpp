#include "dynamics/system/partition.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/chains.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Model;
using Eigen::VectorXd;

namespace {

dynamics::SystemTerms terms_at(const Model& model, const VectorXd& q) {
  dynamics::SystemTerms terms(model);
  terms.update_positions(0.0, q);
  terms.update_jacobian();
  terms.update_mass();
  return terms;
}

// Two equal arms hanging a bar from the ground, and a third, parallel one between them.
Model make_parallelogram(bool with_third_arm) {
  Model model;
  const int bar = test::add_body(model, dynamics::make_rigid_body("bar", 3.0, 1.0));
  const auto add_arm = [&](double x, const std::string& name) {
    const int arm = test::add_body(model, dynamics::make_rigid_body(name, 1.0, 0.1));
    test::add_pin(model, name + "_top", test::add_marker(model, dynamics::kGround, {x, 0.0}),
                  test::add_marker(model, arm, {-0.5, 0.0}));
    test::add_pin(model, name + "_bottom", test::add_marker(model, arm, {0.5, 0.0}),
                  test::add_marker(model, bar, {x, 0.0}));
  };
  add_arm(-1.0, "left");
  add_arm(1.0, "right");
  if (with_third_arm) add_arm(0.3, "middle");
  dynamics::number_model(model);
  return model;
}

VectorXd place_parallelogram(const Model& model, double angle) {
  VectorXd q(model.num_coordinates);
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  q.head<3>() << along, 0.0;
  const double x[] = {-1.0, 1.0, 0.3};
  for (std::size_t arm = 1; arm < model.bodies.size(); ++arm) {
    q.segment<3>(3 * static_cast<Eigen::Index>(arm)) << x[arm - 1] + 0.5 * along.x(), 0.5 * along.y(), angle;
  }
  return q;
}

}  // namespace

TEST_CASE(
    "Independent and dependent coordinates are all coordinates, and the dependents' Jacobian is regular",
    "[system]") {
  const Model model = make_parallelogram(false);
  for (const double angle : {-1.3, -0.4, 0.2, 1.1, 2.0}) {
    const dynamics::SystemTerms terms = terms_at(model, place_parallelogram(model, angle));
    const dynamics::Partition partition = dynamics::choose_partition(terms);
    REQUIRE(partition.independent.size() == 1);
    REQUIRE(partition.dependent.size() == 8);
    CHECK(std::is_sorted(partition.dependent.begin(), partition.dependent.end()));
    std::vector<int> all = partition.dependent;
    all.insert(all.end(), partition.independent.begin(), partition.independent.end());
    std::sort(all.begin(), all.end());
    for (int i = 0; i < 9; ++i) CHECK(all[static_cast<std::size_t>(i)] == i);
    const Eigen::MatrixXd Phi_d = terms.jacobian().dense()(Eigen::all, partition.dependent);
    CHECK(Phi_d.jacobiSvd().singularValues().minCoeff() > 0.05);
  }
}

TEST_CASE("Coordinates of light bodies are the dependent ones", "[system]") {
  // Two bodies pinned together: what is free of the pair are the heavy one's coordinates and one angle of the
  // light.
  Model model;
  test::add_body(model, dynamics::make_rigid_body("light", 1.0, 0.5));
  test::add_body(model, dynamics::make_rigid_body("heavy", 1e4, 2e4));
  test::add_pin(model, "pin", test::add_marker(model, 0, {0.2, 0.1}),
                test::add_marker(model, 1, {-0.3, 0.4}));
  dynamics::number_model(model);
  VectorXd q(6);
  q << 0.5, 0.7, 0.0, 1.0, 0.4, 0.0;
  const dynamics::Partition partition = dynamics::choose_partition(terms_at(model, q));
  CHECK(partition.dependent == std::vector<int>{0, 1});
}

TEST_CASE("The dependents of a long chain follow the independents as closely as those of a short one",
          "[system]") {
  // 70 and 80 links have 142 and 162 constraints, on both sides of where the rule of the choice changes.
  const auto smallest_share = [](int num_links) {
    const test::Chain chain = test::make_closed_chain(num_links);
    const dynamics::SystemTerms terms = terms_at(chain.model, chain.state.q);
    const dynamics::Partition partition = dynamics::choose_partition(terms);
    const Eigen::MatrixXd Phi_d = terms.jacobian().dense()(Eigen::all, partition.dependent);
    const VectorXd singular = Phi_d.jacobiSvd().singularValues();
    return singular.minCoeff() / singular.maxCoeff();
  };
  const double of_short = smallest_share(70);
  CHECK(of_short > 1e-4);
  CHECK(smallest_share(80) > 0.25 * of_short);
}

TEST_CASE("The positions of a long open chain follow its angles", "[system]") {
  // These are the coordinates of classical mechanics.
  const test::Chain chain = test::make_open_chain(120);
  const dynamics::Partition partition = dynamics::choose_partition(terms_at(chain.model, chain.state.q));
  REQUIRE(partition.independent.size() == 120);
  CHECK(std::all_of(partition.independent.begin(), partition.independent.end(),
                    [](int coordinate) { return coordinate % 3 == 2; }));
}

TEST_CASE("A model without joints has no dependents", "[system]") {
  Model model;
  test::add_body(model, dynamics::make_rigid_body("free", 1.0, 0.5));
  dynamics::number_model(model);
  const dynamics::SystemTerms terms = terms_at(model, VectorXd::Zero(3));
  CHECK(dynamics::choose_partition(terms).independent == std::vector<int>{0, 1, 2});
  CHECK(dynamics::choose_partition(terms).dependent.empty());
  CHECK(dynamics::find_dependent_constraints(terms).empty());
}

TEST_CASE("Constraints that follow from others are found, and only those that take part", "[system]") {
  const Model sound = make_parallelogram(false), overheld = make_parallelogram(true);
  CHECK(dynamics::find_dependent_constraints(terms_at(sound, place_parallelogram(sound, -1.1))).empty());
  const std::vector<int> found =
      dynamics::find_dependent_constraints(terms_at(overheld, place_parallelogram(overheld, -1.1)));
  // A third parallel arm holds what the other two hold already: all three take part, with x and y of both
  // ends.
  CHECK(found.size() == 12);

  // A free body pinned twice to another, besides a sound pair: only the two pins are named.
  Model model;
  for (const char* name : {"a", "b", "c", "d"})
    test::add_body(model, dynamics::make_rigid_body(name, 1.0, 0.5));
  test::add_pin(model, "sound", test::add_marker(model, 0, {1.0, 0.0}),
                test::add_marker(model, 1, {-1.0, 0.0}));
  test::add_pin(model, "first", test::add_marker(model, 2, {1.0, 0.0}),
                test::add_marker(model, 3, {-1.0, 0.0}));
  test::add_pin(model, "second", test::add_marker(model, 2, {1.5, 0.0}),
                test::add_marker(model, 3, {-0.5, 0.0}));
  dynamics::number_model(model);
  VectorXd q = VectorXd::Zero(12);
  q[3] = 2.0;
  q[9] = 2.0;
  // Along the line of both pins (x) the second adds nothing.
  CHECK(dynamics::find_dependent_constraints(terms_at(model, q)) == std::vector<int>{2, 4});
}

TEST_CASE("Constraints that follow from others are found among many, too", "[system]") {
  // Links 39 and 40, which share the pin with rows 80 and 81, are pinned a second time, beside it: along the
  // line through both pins that adds nothing, and the line is parallel to no axis.
  test::Chain chain = test::make_open_chain(80);
  const auto add_marker_at = [&](int link, const Eigen::Vector2d& place) {
    const Eigen::Vector3d q = chain.state.q.segment<3>(3 * link);
    const Eigen::Vector2d arm = Eigen::Rotation2Dd(-q[2]) * (place - q.head<2>());
    return test::add_marker(chain.model, link, arm);
  };
  const Eigen::Vector3d q = chain.state.q.segment<3>(3 * 40);
  const Eigen::Vector2d beside = q.head<2>() + Eigen::Vector2d(0.05, 0.03);
  test::add_pin(chain.model, "second", add_marker_at(39, beside), add_marker_at(40, beside));
  dynamics::number_model(chain.model);
  REQUIRE(chain.model.num_constraints == 162);
  CHECK(dynamics::find_dependent_constraints(terms_at(chain.model, chain.state.q)) ==
        std::vector<int>{80, 81, 160, 161});
}

// The pivot vanishes with the sine of the angle, and is largest where the bars are upright.
TEST_CASE("the usual size of the smallest pivot does not depend on how near a change point is") {
  const Model model = make_parallelogram(false);
  const auto usual_at = [&](double angle) {
    return dynamics::calc_usual_pivot(model, 0.0, place_parallelogram(model, angle));
  };
  const double usual = usual_at(1.0);
  const double best =
      dynamics::choose_partition(terms_at(model, place_parallelogram(model, 0.5 * 3.14159))).smallest_pivot;
  CHECK(usual > 0.3 * best);
  CHECK(usual < 3.0 * best);
  for (const double angle : {0.1, 1e-3, 1e-6, 0.0}) CHECK(std::abs(usual_at(angle) / usual - 1.0) < 1e-12);
}

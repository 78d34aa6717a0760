#include <cmath>

#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

Superelement make(const std::string& name) {
  return make_superelement(read_design(testing::source_path("meshes/truck/" + name + ".toml")));
}

double round_to_hundredths(double value) {
  return std::round(100.0 * value) / 100.0;
}

TEST_CASE("the truck's chassis has the frequencies, mass and inertia that the paper prints") {
  const Superelement s = make("chassis");
  // Kim, Shabana & Haug (1983): clamped frequencies in the text, mass and inertia in table 2, 12 elements.
  const double printed[] = {6.11, 6.11, 38.31, 38.31, 83.36, 83.36};
  for (int i = 0; i < 6; ++i) CHECK(round_to_hundredths(s.frequency_hz(i)) == printed[i]);
  CHECK(s.elements.cols() == 12);
  CHECK(s.num_elastic_dofs == 36);
  CHECK(s.num_modes() == 36);
  CHECK(s.inertia.mass == Approx(11950.0).epsilon(1e-6));
  CHECK(s.inertia.second_moment == Approx(58300.0).epsilon(1e-5));
  CHECK(s.inertia.first_moment.norm() < 1e-9);
  CHECK(s.damping_ratio == Eigen::VectorXd::Constant(36, 0.01));
}

TEST_CASE("every frequency of the truck's bodies comes as an exact pair") {
  for (const char* name : {"chassis", "long_arm"}) {
    const Superelement s = make(name);
    for (int i = 0; i < s.num_modes(); ++i) CHECK(s.cluster(i) == i / 2 + 1);
  }
}

TEST_CASE("the truck's chassis has its joints and springs on named nodes") {
  const Superelement s = make("chassis");
  const std::pair<const char*, double> places[] = {{"front_end", -3.8257},   {"front_short_pivot", -3.034},
                                                   {"front_spring", -2.175}, {"front_long_pivot", -1.059},
                                                   {"middle", 0.0},          {"rear_long_pivot", 1.059},
                                                   {"rear_spring", 2.175},   {"rear_short_pivot", 3.034},
                                                   {"rear_end", 3.8257}};
  for (const auto& [name, x] : places) {
    const int node = find_point(s, name);
    REQUIRE(node >= 0);
    CHECK((s.node_positions.col(node) - Eigen::Vector2d(x, 0.0)).norm() < 1e-12);
  }
  for (const double x : {-1.617, -0.5295, 0.5295, 1.617}) {
    CHECK((s.node_positions.colwise() - Eigen::Vector2d(x, 0.0)).colwise().norm().minCoeff() < 1e-12);
  }
}

TEST_CASE("the truck's long arm has the frequencies, mass and inertia that the paper prints") {
  const Superelement s = make("long_arm");
  CHECK(round_to_hundredths(s.frequency_hz(0)) == 88.92);
  CHECK(round_to_hundredths(s.frequency_hz(1)) == 88.92);
  CHECK(s.num_elastic_dofs == 6);
  CHECK(s.num_modes() == 6);
  CHECK(s.inertia.mass == Approx(22.4).epsilon(1e-6));
  CHECK(s.inertia.second_moment == Approx(2.38).epsilon(1e-5));
  CHECK(s.node_positions(0, find_point(s, "chassis_end")) == Approx(0.559017));
  CHECK(s.node_positions(0, find_point(s, "axle_end")) == Approx(-0.559017));
  CHECK(s.node_positions.col(find_point(s, "middle")).norm() == 0.0);
}

TEST_CASE("the chassis' bending modes meet the clamped beam's exact shape at its end") {
  // Each half is a cantilever of length l and mass m/2: |φ(l)| = 2/√(mass) of a normalised mode (Blevins,
  // table 8-1), and the pair shares the body's mass: 2/√m at both ends.
  const Superelement s = make("chassis");
  const int end = find_point(s, "front_end");
  CHECK(std::abs(s.shapes(3 * end + 1, 0)) == Approx(2.0 / std::sqrt(11950.0)).epsilon(1e-4));
}

TEST_CASE("equal designs give equal superelements, hash and all") {
  const Design design = read_design(testing::source_path("meshes/truck/chassis.toml"));
  const Superelement a = make_superelement(design), b = make_superelement(design);
  CHECK(a.shapes == b.shapes);
  CHECK(a.inertia.P == b.inertia.P);
  CHECK(a.resultants == b.resultants);
}

TEST_CASE("the truck's chassis has the same modes for every numbering, start vector and method") {
  Design design = read_design(testing::source_path("meshes/truck/chassis.toml"));
  const Superelement all = make_superelement(design);
  const fem::BeamModel model = design.model;
  design.modes.wanted = ModeCount{6};
  const Superelement six = make_superelement(design);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Design other = design;
    other.model = testing::renumber(model, seed);
    other.reference_node = fem::find_node(other.model.mesh, "middle");
    for (InterfaceFreedom& freedom : other.reduction.interface) {
      const std::string& name = model.mesh.named_nodes[static_cast<std::size_t>(freedom.point)].name;
      freedom.node = fem::find_node(other.model.mesh, name);
    }
    const Superelement sparse = make_superelement(other, {.method = EigenMethod::kSparse, .seed = seed});
    CHECK(testing::calc_difference(six, sparse) < 1e-10);
    other.modes = {};
    CHECK(testing::calc_difference(all, make_superelement(other)) < 1e-10);
  }
}

}  // namespace
}  // namespace sprung::reduce

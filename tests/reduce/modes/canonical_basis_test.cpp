#include "reduce/modes/canonical_basis.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "reduce/modes/clusters.h"
#include "reduce/modes/largest_displacement.h"
#include "reduce/reduction/distance_weighted_mass.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using testing::add_line;
using testing::calc_difference;
using testing::make_design;
using testing::make_model;
using testing::make_section;

constexpr double kSame = 1e-10;  // what two bases of one body may differ by

struct Body {
  const char* name;
  fem::BeamModel model;
  Eigen::Vector2d reference;
};

// Two unequal masses at the ends of two equal cantilevers, of which the second is larger by a share.
fem::BeamModel make_uneven_pair(double share) {
  fem::BeamModel model = make_model();
  add_line(model, {-1.1, 0.3}, {0.0, 0.0}, 5);
  add_line(model, {0.0, 0.0}, {1.1, -0.3}, 5);
  model.point_masses = {{.node = 0, .mass = 1.0, .inertia = 0.0},
                        {.node = 10, .mass = 1.0 + share, .inertia = 0.0}};
  return model;
}

fem::BeamModel make_uneven_star(double share) {
  fem::BeamModel model = testing::make_star(4, 0.37);
  model.point_masses = {{.node = testing::find_node_at(model, {1.2 * std::cos(0.37), 1.2 * std::sin(0.37)}),
                         .mass = share,
                         .inertia = 0.0}};
  return model;
}

std::vector<Body> make_bodies() {
  const Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  std::vector<Body> bodies;
  bodies.push_back({"two cantilevers", testing::make_star(2, 0.0, 6), origin});
  bodies.push_back({"two cantilevers, tilted", testing::make_star(2, 0.7, 6), origin});
  bodies.push_back({"two cantilevers at 45 degrees", testing::make_star(2, 0.25 * M_PI, 6), origin});
  bodies.push_back({"four cantilevers", testing::make_star(4, 0.0), origin});
  bodies.push_back({"four cantilevers, tilted", testing::make_star(4, 0.37), origin});
  bodies.push_back({"four cantilevers at 45 degrees", testing::make_star(4, 0.25 * M_PI), origin});
  bodies.push_back({"six cantilevers", testing::make_star(6, 0.1, 3), origin});
  bodies.push_back({"spoked square", testing::make_spoked_square(0.0), origin});
  bodies.push_back({"spoked square, tilted", testing::make_spoked_square(0.21), origin});
  bodies.push_back({"spoked square held at a corner", testing::make_spoked_square(0.0), {0.5, 0.5}});
  for (const double share : {1e-3, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12}) {
    bodies.push_back({"uneven pair", make_uneven_pair(share), origin});
    bodies.push_back({"uneven star", make_uneven_star(share), origin});
  }
  return bodies;
}

// The factor by which close frequencies enlarge the difference: vectors of modes with a gap g are determined
// only to the rounding of K divided by g. 1 for bodies whose frequencies are equal or well separated.
double calc_separation(const Superelement& s) {
  double nearest = 1.0;
  for (Eigen::Index i = 1; i < s.num_modes(); ++i) {
    if (s.cluster(i) != s.cluster(i - 1))
      nearest = std::min(nearest, 1.0 - s.frequency_hz(i - 1) / s.frequency_hz(i));
  }
  return std::min(1.0, nearest / 1e-3);
}

TEST_CASE("all modes of a body have one basis for every node numbering") {
  for (const Body& body : make_bodies()) {
    CAPTURE(body.name);
    const Superelement first = make_superelement(make_design(body.model, body.reference, {}));
    REQUIRE(first.num_modes() == 3 * body.model.mesh.num_nodes() - 3);
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      CAPTURE(seed, calc_separation(first));
      const fem::BeamModel renumbered = testing::renumber(body.model, seed);
      const Superelement other = make_superelement(make_design(renumbered, body.reference, {}));
      CHECK(other.cluster == first.cluster);
      CHECK(calc_difference(first, other) < kSame / calc_separation(first));
    }
  }
}

TEST_CASE("the lowest modes of a body have one basis for every start vector and solution method") {
  for (const Body& body : make_bodies()) {
    CAPTURE(body.name);
    // Up to the first gap after twelve modes.
    const ModalProblem problem =
        testing::make_modal_problem(body.model, testing::find_node_at(body.model, body.reference));
    const ClampedModes lowest = calc_clamped_modes(problem, 12, {.method = EigenMethod::kDense});
    const WantedModes request{.wanted = ModeCount{static_cast<int>(lowest.cluster.size())}};
    const Superelement dense =
        make_superelement(make_design(body.model, body.reference, request), {.method = EigenMethod::kDense});
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(seed, calc_separation(dense));
      const fem::BeamModel renumbered = testing::renumber(body.model, 100 + seed);
      const Superelement sparse = make_superelement(make_design(renumbered, body.reference, request),
                                                    {.method = EigenMethod::kSparse, .seed = seed});
      CHECK(sparse.cluster == dense.cluster);
      // Polished, the low modes come closer to each other than all modes above do.
      CHECK(calc_difference(dense, sparse) < kSame / std::min(1.0, 10.0 * calc_separation(dense)));
    }
  }
}

TEST_CASE("without the rule the solver's basis of a cluster depends on the start vector") {
  const fem::BeamModel model = testing::make_star(4, 0.37);
  const ModalProblem problem = testing::make_modal_problem(model, 0);
  const ClampedModes a = calc_clamped_modes(problem, 4, {.method = EigenMethod::kSparse, .seed = 1});
  const ClampedModes b = calc_clamped_modes(problem, 4, {.method = EigenMethod::kSparse, .seed = 2});
  REQUIRE(find_cluster_of(a.cluster, 0).size() == 4);
  const Eigen::VectorXd alike =
      (a.pairs.vectors.transpose() * problem.mass * b.pairs.vectors).diagonal().cwiseAbs();
  CHECK(alike.minCoeff() < 0.99);
}

TEST_CASE("in a pair the first mode has all the heave and the second all the pitch, to the positive side") {
  const Superelement s = make_superelement(make_design(testing::make_star(2, 0.0, 6), {0.0, 0.0}, {}));
  REQUIRE(s.cluster(1) == s.cluster(0));
  CHECK(s.inertia.P(1, 0) > 0.5 * std::sqrt(s.inertia.mass));
  CHECK(std::abs(s.inertia.P(1, 1)) < 1e-12 * std::sqrt(s.inertia.mass));
  CHECK(std::abs(s.inertia.c(0)) < 1e-12 * std::sqrt(s.inertia.second_moment));
  CHECK(s.inertia.c(1) > 0.5 * std::sqrt(s.inertia.second_moment));
}

TEST_CASE("in a quadruple the modes carry heave, surge and pitch one after the other") {
  const Superelement s = make_superelement(make_design(testing::make_star(4, 0.37), {0.0, 0.0}, {}));
  REQUIRE(s.cluster(3) == s.cluster(0));
  const double noise = 1e-12 * std::sqrt(s.inertia.mass);
  CHECK(s.inertia.P.row(1).segment(1, 3).cwiseAbs().maxCoeff() < noise);
  CHECK(s.inertia.P.row(0).segment(2, 2).cwiseAbs().maxCoeff() < noise);
  CHECK(std::abs(s.inertia.c(3)) < 1e-12 * std::sqrt(s.inertia.second_moment));
  CHECK(s.inertia.P(1, 0) > 0.1 * std::sqrt(s.inertia.mass));
  CHECK(s.inertia.P(0, 1) > 0.1 * std::sqrt(s.inertia.mass));
  CHECK(s.inertia.c(2) > 0.1 * std::sqrt(s.inertia.second_moment));
}

TEST_CASE("a small participation just above the threshold decides, one just below does not") {
  // Two modes of one cluster that move two unlike places: the participation row points along an angle that
  // neither the moment nor the displacement rule would choose.
  const double angle = 0.6;
  for (const double share : {2.0 * kParticipationThreshold, 0.5 * kParticipationThreshold}) {
    BasisFrame frame;
    frame.node_positions.resize(2, 2);
    frame.node_positions << 1.0, -1.0, 0.0, 0.0;
    frame.mass = 4.0;
    frame.second_moment = 1.0;
    frame.participation_rows = Eigen::MatrixXd::Zero(3, 6);
    frame.participation_rows(0, 1) = 2.0 * share * std::cos(angle);
    frame.participation_rows(0, 4) = 2.0 * share * std::sin(angle);
    frame.make_weighted_mass = [] {
      Eigen::SparseMatrix<double> mass(6, 6);
      mass.insert(1, 1) = 0.5;
      mass.insert(4, 4) = -0.5;
      return mass;
    };
    Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(6, 2);
    shapes(1, 0) = shapes(4, 1) = 1.0;
    const Eigen::MatrixXd rotation = calc_canonical_rotation(shapes, Eigen::Vector2i(1, 1), frame);
    CAPTURE(share, rotation);
    CHECK((rotation.transpose() * rotation - Eigen::Matrix2d::Identity()).norm() < 1e-15);
    if (share > kParticipationThreshold) {
      CHECK(rotation(0, 0) == Approx(std::cos(angle)).epsilon(1e-13));
      CHECK(rotation(1, 0) == Approx(std::sin(angle)).epsilon(1e-13));
    } else {
      CHECK(std::abs(rotation(0, 0)) < 1e-15);  // ∫x φᵀφ dm ascending: the place at negative x first
      CHECK(rotation(1, 0) == Approx(1.0));
    }
  }
}

TEST_CASE("modes of different clusters are not mixed") {
  BasisFrame frame;
  frame.node_positions = Eigen::Matrix2Xd::Ones(2, 1);
  frame.mass = frame.second_moment = 1.0;
  frame.participation_rows = Eigen::MatrixXd::Identity(3, 3);
  Eigen::MatrixXd shapes(3, 2);
  shapes << -0.8, 0.6, 0.6, 0.8, 0.1, 0.2;
  const Eigen::MatrixXd rotation = calc_canonical_rotation(shapes, Eigen::Vector2i(1, 2), frame);
  Eigen::Matrix2d expected;
  expected << -1.0, 0.0, 0.0, 1.0;  // signs by the largest participation
  CHECK(rotation == expected);
}

TEST_CASE("the largest displacement is found by position, not by node number") {
  Eigen::Matrix2Xd positions(2, 3);
  positions << -1.0, 1.0, 1.0, 0.0, 0.5, -0.5;
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(9, 2);
  shapes(0, 0) = 1.004;  // largest by itself, within 1 % of
  shapes(3, 1) = -1.0;   // these two at the larger x, of which
  shapes(7, 0) = 0.999;  // this one has the smaller y
  CHECK(find_largest_displacement(shapes, positions) == 3);
  shapes(4, 0) = 1.0;  // y comes before x at one node
  CHECK(find_largest_displacement(shapes, positions) == 4);
  shapes(0, 0) = 1.2;
  CHECK(find_largest_displacement(shapes, positions) == 0);
  shapes(8, 1) = 1.1;  // a rotation counts with the body's radius, here √1.25
  CHECK(find_largest_displacement(shapes, positions) == 8);
}

TEST_CASE("the distance-weighted mass of a rigid translation is the first moment, of x it is ∫x³ dm") {
  fem::BeamModel model = make_model();
  const Eigen::Vector2d from(0.4, -0.2), to(1.9, 0.7), origin(0.3, 0.1);
  add_line(model, from, to, 3);
  model.point_masses = {{.node = 2, .mass = 1.7, .inertia = 0.3}};
  const Eigen::SparseMatrix<double> weighted = calc_distance_weighted_mass(model, origin);
  Eigen::VectorXd translation = Eigen::VectorXd::Zero(12), stretch = translation;
  for (int node = 0; node < 4; ++node) {
    const Eigen::Vector2d p = model.mesh.node_positions.col(node) - origin;
    translation(3 * node) = std::cos(0.3);
    translation(3 * node + 1) = std::sin(0.3);
    stretch(3 * node) =
        p.x();  // uniform stretch along x: each line stays straight, turning by −sin·cos of its angle
    stretch(3 * node + 2) = -(to - from).normalized().prod();
  }
  const double mass = make_section().mass_per_length * (to - from).norm(), a = from.x() - origin.x(),
               b = to.x() - origin.x();
  const double x_point = model.mesh.node_positions(0, 2) - origin.x();
  CHECK(translation.dot(weighted * translation) ==
        Approx(mass * 0.5 * (a + b) + 1.7 * x_point).epsilon(1e-13));
  const double cube = mass * (b * b * b * b - a * a * a * a) / (4.0 * (b - a)) + 1.7 * std::pow(x_point, 3);
  CHECK(stretch.dot(weighted * stretch) == Approx(cube).epsilon(1e-13));
}

}  // namespace
}  // namespace sprung::reduce

// Geometric stiffness under reference loads against inextensible kinematics: what a load's stiffness times −½
// is must be the displacement, in the load's direction, that bending without stretching makes.
#include "reduce/reduction/reference_stiffness.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>

#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

constexpr double kTolerance = 1e-9;  // relative, of static solutions and sums over quadrature points

// Two arms at an angle with shear and rotary inertia, a point mass, held at the end of the first.
fem::BeamModel make_bent_arm() {
  fem::BeamModel model = testing::make_model({testing::make_section(true), testing::make_section()});
  testing::add_line(model, {0.3, -0.2}, {1.5, 0.4}, 3, 0);
  testing::add_line(model, {1.5, 0.4}, {1.1, 1.7}, 2, 1);
  model.point_masses = {{.node = 5, .mass = 2.3, .inertia = 0.1}};
  model.mesh.named_nodes = {
      {.name = "foot", .node = 0}, {.name = "knee", .node = 3}, {.name = "tip", .node = 5}};
  return model;
}

// Displacement of second order of a beam that bends without stretching: −½∫w'² ds along each element, from
// the held end on, summed over small pieces; and its moments over the mass.
struct Shortening {
  Eigen::Vector2d at_knee = Eigen::Vector2d::Zero(), at_tip = Eigen::Vector2d::Zero();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();  // ∫u dm
  double radial = 0.0, angular = 0.0;                // ∫r·u dm, ∫(x u_y − y u_x) dm
};

Shortening calc_shortening(const fem::BeamModel& model, const Eigen::VectorXd& shape) {
  constexpr int kIntervals = 400;
  Shortening sum;
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  const Eigen::Vector2d origin = model.mesh.node_positions.col(0);
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const fem::BeamElement element = fem::make_element(model, e);
    const double length = fem::calc_length(element);
    const Eigen::Vector2d axis = (element.second - element.first) / length;
    Eigen::Matrix<double, 6, 1> ends;
    ends << shape.segment<3>(3 * nodes.first), shape.segment<3>(3 * nodes.second);
    const Eigen::Matrix<double, 6, 1> own = fem::calc_rotation(element) * ends;
    const auto displacement = [&](double xi) {
      return double(fem::calc_shape_functions(length, element.properties, xi).row(1) * own);
    };
    const double h = 1.0 / kIntervals;
    for (int i = 0; i < kIntervals; ++i) {
      // Slopes from differences of w: nothing of the code under test.
      const double slope = (displacement((i + 1) * h) - displacement(i * h)) / (h * length);
      const Eigen::Vector2d step = -0.5 * slope * slope * h * length * axis;
      const double dm = element.properties.mass_per_length * length * h;
      const Eigen::Vector2d r = element.first + (i + 0.5) * h * length * axis - origin;
      const Eigen::Vector2d here = u + 0.5 * step;
      sum.moment += dm * here;
      sum.radial += dm * r.dot(here);
      sum.angular += dm * (r.x() * here.y() - r.y() * here.x());
      u += step;
    }
    if (nodes.second == 3) sum.at_knee = u;
  }
  sum.at_tip = u;
  const Eigen::Vector2d r = model.mesh.node_positions.col(5) - origin;
  const double m = model.point_masses.front().mass;
  sum.moment += m * u;
  sum.radial += m * r.dot(u);
  sum.angular += m * (r.x() * u.y() - r.y() * u.x());
  return sum;
}

Superelement make_arm_superelement(int num_modes) {
  return make_superelement(
      testing::make_design(make_bent_arm(), {0.3, -0.2}, {.wanted = ModeCount{num_modes}}));
}

}  // namespace

TEST_CASE("reference stiffness is the second-order displacement of beams that do not stretch") {
  const Superelement s = make_arm_superelement(5);
  const GeometricStiffness& K = *s.geometric_stiffness;
  const Eigen::VectorXd eta = (Eigen::VectorXd(5) << 0.7, -0.4, 0.3, 0.2, -0.1).finished();
  const Shortening exact = calc_shortening(make_bent_arm(), s.shapes * eta);
  const auto form = [&](const Eigen::MatrixXd& matrix) { return -0.5 * eta.dot(matrix * eta); };
  constexpr double kDifferences = 1e-4;  // of 400 intervals, of the order of their square
  CHECK(form(K.point_loads[1][0]) == Approx(exact.at_knee.x()).epsilon(kDifferences));
  CHECK(form(K.point_loads[1][1]) == Approx(exact.at_knee.y()).epsilon(kDifferences));
  CHECK(form(K.point_loads[2][0]) == Approx(exact.at_tip.x()).epsilon(kDifferences));
  CHECK(form(K.point_loads[2][1]) == Approx(exact.at_tip.y()).epsilon(kDifferences));
  CHECK(form(K.centrifugal) == Approx(exact.radial).epsilon(kDifferences));
  CHECK(form(K.angular_acceleration) == Approx(-exact.angular).epsilon(kDifferences));
  CHECK(form(K.acceleration[0]) == Approx(-exact.moment.x()).epsilon(kDifferences));
  CHECK(form(K.acceleration[1]) == Approx(-exact.moment.y()).epsilon(kDifferences));
}

TEST_CASE("the geometric stiffness of a point is the same beside few points and beside many") {
  // 5 modes have 15 pairs: the 9 loads of three points are solved for, or the pairs, where six points
  // have 18. One point hangs on a rigid offset.
  const auto reduce = [](bool all_points) {
    fem::BeamModel model = make_bent_arm();
    model.mesh.node_ids.push_back(7);
    model.mesh.node_positions.conservativeResize(2, 7);
    model.mesh.node_positions.col(6) = Eigen::Vector2d(1.4, 1.8);
    model.couplings = {fem::make_rigid_offset(model.mesh.node_positions, 6, 5)};
    model.mesh.named_nodes[1].node = 6;
    if (all_points) {
      for (const int node : {1, 2, 4})
        model.mesh.named_nodes.push_back({.name = std::to_string(node), .node = node});
    }
    return make_superelement(testing::make_design(model, {0.3, -0.2}, {.wanted = ModeCount{5}}));
  };
  const Superelement few = reduce(false), many = reduce(true);
  REQUIRE(few.points.size() == 3);
  REQUIRE(many.points.size() == 6);
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t freedom = 0; freedom < 3; ++freedom) {
      const Eigen::MatrixXd& expected = few.geometric_stiffness->point_loads[p][freedom];
      const Eigen::MatrixXd& found = many.geometric_stiffness->point_loads[p][freedom];
      CHECK((found - expected).norm() <= kTolerance * few.geometric_stiffness->point_loads[2][0].norm());
      CHECK((p == 0 || freedom == 2) ==
            (expected.norm() < 0.1 * few.geometric_stiffness->point_loads[2][1].norm()));
    }
  }
}

TEST_CASE("a moment on an open frame strains no axis, and a load on the held node nothing") {
  const GeometricStiffness K = *make_arm_superelement(5).geometric_stiffness;
  const double size = K.point_loads[2][0].norm();
  for (const Eigen::MatrixXd& of_foot : K.point_loads[0]) CHECK(of_foot.norm() == 0.0);
  CHECK(K.point_loads[1][2].norm() < kTolerance * size);
  CHECK(K.point_loads[2][2].norm() < kTolerance * size);
}

TEST_CASE("a moment on a closed frame strains its axes") {
  fem::BeamModel model = testing::make_spoked_square(0.3);
  model.mesh.named_nodes = {
      {.name = "corner",
       .node = testing::find_node_at(
           model, 0.5 * Eigen::Vector2d(std::cos(0.3) + std::sin(0.3), std::sin(0.3) - std::cos(0.3)))}};
  REQUIRE(model.mesh.named_nodes[0].node >= 0);
  const Superelement s = make_superelement(testing::make_design(model, {0.0, 0.0}, {.wanted = AllModes{}}));
  const auto& loads = s.geometric_stiffness->point_loads[0];
  CHECK(loads[2].norm() > 0.01 * loads[0].norm());
}

TEST_CASE("reference stiffness does not depend on the number or direction of a straight arm's elements") {
  // The same shape, a cubic, is in the modes of any mesh: compared by its tip's shortening under a tip force.
  const auto shorten = [](const fem::BeamModel& model) {
    const Superelement s = make_superelement(testing::make_design(model, {0.0, 0.0}, {.wanted = AllModes{}}));
    const int tip = find_point(s, "tip");
    // Modal coordinates of the static deflection under a unit force across at the tip.
    const Eigen::Vector2d across(-0.6, 0.8);
    const Eigen::VectorXd work = s.shapes.middleRows(3 * tip, 2).transpose() * across;
    const Eigen::VectorXd eta = s.stiffness.llt().solve(work);
    const auto& K = s.geometric_stiffness->point_loads[0];
    return 0.8 * eta.dot(K[0] * eta) + 0.6 * eta.dot(K[1] * eta);
  };
  const auto make_arm = [](int num_elements) {
    fem::BeamModel model = testing::make_model();
    testing::add_line(model, {0.0, 0.0}, {0.96, 0.72}, num_elements);
    model.mesh.named_nodes = {{.name = "tip", .node = num_elements}};
    return model;
  };
  // ∫w'² ds of w = F (3Ls² − s³)/6EI: 2F²L⁵/15(EI)².
  const double EI = testing::make_section().bending_rigidity;
  const double expected = 2.0 * std::pow(1.2, 5) / (15.0 * EI * EI);
  CHECK(shorten(make_arm(1)) == Approx(expected).epsilon(1e-6));
  CHECK(shorten(make_arm(6)) == Approx(expected).epsilon(1e-6));
  CHECK(shorten(testing::renumber(make_arm(6), 5)) == Approx(expected).epsilon(1e-6));
}

}  // namespace sprung::reduce

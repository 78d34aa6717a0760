// Section loads of moving bodies against closed forms, sums over the part beyond a cut, and the sum over all
// modes.
#include "reduce/reduction/static_response.h"

#include <Eigen/Cholesky>
#include <functional>

#include "fem/assembly.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

constexpr double kTolerance = 1e-8;  // relative, of static solutions

TEST_CASE("a free beam that a force at its end accelerates has the exact moment, shear and axial force") {
  // Force F across and H along at s = 0. The beam accelerates by F/m (4 − 6 s/L) across and H/m along:
  // M = F s (1 − s/L)², Q = −M′, N = −H (1 − s/L), on any mesh and whatever node holds the frame.
  const Eigen::Vector2d from(0.3, -0.2), t(0.8, 0.6), n(-0.6, 0.8);
  const double F = 120.0, H = 70.0, L = 2.0;
  fem::BeamModel model = testing::make_model();
  const double places[] = {0.0, 0.3, 1.1, 1.4, L};
  for (int i = 0; i < 4; ++i) testing::add_line(model, from + places[i] * t, from + places[i + 1] * t, 1);
  model.mesh.named_nodes = {{.name = "end", .node = 0}};
  for (const double held : {0.0, 1.1, L}) {
    const Superelement body =
        make_superelement(testing::make_design(model, from + held * t, {.wanted = ModeCount{3}}));
    const UnitLoads& loads = *body.section_loads;
    const double m = body.inertia.mass;
    const Eigen::Vector2d a = F / m * (4.0 - 6.0 * held / L) * n + H / m * t;
    const Eigen::Vector2d force = F * n + H * t;
    const Eigen::VectorXd sum = loads.point_load * Eigen::Vector3d(force.x(), force.y(), 0.0) +
                                loads.acceleration * Eigen::Vector4d(a.x(), a.y(), -6.0 * F / (m * L), 0.0);
    for (int e = 0; e < 4; ++e) {
      for (int end = 0; end < 2; ++end) {
        CAPTURE(held, e, end);
        const double x = places[e + end] / L;
        const Eigen::Vector3d found = sum.segment<3>(6 * e + 3 * end);
        CHECK(found(0) == Approx(-H * (1.0 - x)).margin(kTolerance * H));
        CHECK(found(1) == Approx(-F * (1.0 - x) * (1.0 - 3.0 * x)).margin(kTolerance * F));
        CHECK(found(2) == Approx(F * L * x * (1.0 - x) * (1.0 - x)).margin(kTolerance * F * L));
      }
    }
  }
}

// A chain of elements from the held node outwards, with shear, rotary inertia and a point mass at its end.
fem::BeamModel make_chain() {
  fem::BeamModel model = testing::make_model({testing::make_section(true), testing::make_section()});
  testing::add_line(model, {0.3, -0.2}, {1.5, 0.4}, 3, 0);
  testing::add_line(model, {1.5, 0.4}, {1.1, 1.7}, 2, 1);
  model.point_masses = {{.node = 5, .mass = 2.3, .inertia = 0.1}};
  model.mesh.named_nodes = {
      {.name = "foot", .node = 0}, {.name = "knee", .node = 3}, {.name = "tip", .node = 5}};
  return model;
}

// Acceleration of a point, and angular acceleration of its section, in an element.
using Field = std::function<Eigen::Vector3d(const fem::BeamElement&, int element, double xi)>;

// N, Q, M at the first end of an element, from the inertia of everything beyond it.
Eigen::Vector3d sum_beyond(const fem::BeamModel& model, int cut, const Field& field) {
  const fem::BeamElement at = fem::make_element(model, cut);
  const Eigen::Vector2d t = (at.second - at.first).normalized(), n(-t.y(), t.x());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto add = [&](const Eigen::Vector2d& r, double mass, double inertia, const Eigen::Vector3d& motion) {
    const Eigen::Vector2d force = -mass * motion.head<2>(), arm = r - at.first;
    sum += Eigen::Vector3d(force.dot(t), force.dot(n),
                           arm.x() * force.y() - arm.y() * force.x() - inertia * motion.z());
  };
  const int num_elements = model.mesh.num_elements();
  for (int e = cut; e < num_elements; ++e) {
    const fem::BeamElement element = fem::make_element(model, e);
    constexpr int kIntervals = 400;
    for (int i = 0; i < kIntervals; ++i) {  // the midpoint rule
      const double xi = (i + 0.5) / kIntervals, ds = fem::calc_length(element) / kIntervals;
      add(element.first + xi * (element.second - element.first), element.properties.mass_per_length * ds,
          element.properties.rotary_inertia * ds, field(element, e, xi));
    }
  }
  const fem::PointMass& tip = model.point_masses.front();
  const fem::BeamElement last = fem::make_element(model, num_elements - 1);
  add(last.second, tip.mass, tip.inertia, field(last, num_elements - 1, 1.0));
  return sum;
}

TEST_CASE("the inertia of the part beyond each cut is in equilibrium with the section loads there") {
  const fem::BeamModel model = make_chain();
  const Superelement body =
      make_superelement(testing::make_design(model, {0.3, -0.2}, {.wanted = ModeCount{4}}));
  const UnitLoads& loads = *body.section_loads;
  const Eigen::Vector2d origin(0.3, -0.2);
  const auto check = [&](const Eigen::VectorXd& resultants, const Field& field) {
    const Eigen::Vector3d scale = sum_beyond(model, 0, field).cwiseAbs().array() + 1e-9;
    for (int e = 0; e < model.mesh.num_elements(); ++e) {
      CAPTURE(e);
      const Eigen::Vector3d error = resultants.segment<3>(6 * e) - sum_beyond(model, e, field);
      CHECK(error.cwiseAbs().maxCoeff() < 1e-4 * scale.maxCoeff());  // of the midpoint rule
    }
  };
  const auto position = [&](const fem::BeamElement& element, double xi) {
    return Eigen::Vector2d(element.first + xi * (element.second - element.first) - origin);
  };
  check(loads.acceleration.col(0), [](auto&&...) { return Eigen::Vector3d(1.0, 0.0, 0.0); });
  check(loads.acceleration.col(1), [](auto&&...) { return Eigen::Vector3d(0.0, 1.0, 0.0); });
  check(loads.acceleration.col(2), [&](const fem::BeamElement& element, int, double xi) {
    const Eigen::Vector2d r = position(element, xi);
    return Eigen::Vector3d(-r.y(), r.x(), 1.0);
  });
  check(loads.acceleration.col(3), [&](const fem::BeamElement& element, int, double xi) {
    const Eigen::Vector2d r = position(element, xi);
    return Eigen::Vector3d(-r.x(), -r.y(), 0.0);
  });
  for (int mode = 0; mode < 4; ++mode) {
    const Field shape = [&](const fem::BeamElement& element, int e, double xi) {
      const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
      Eigen::Matrix<double, 6, 1> ends;
      ends << body.shapes.col(mode).segment<3>(3 * nodes.first),
          body.shapes.col(mode).segment<3>(3 * nodes.second);
      const Eigen::Vector3d own =
          fem::calc_shape_functions(fem::calc_length(element), element.properties, xi) *
          fem::calc_rotation(element) * ends;
      const Eigen::Vector2d t = (element.second - element.first).normalized();
      return Eigen::Vector3d(own.x() * t.x() - own.y() * t.y(), own.x() * t.y() + own.y() * t.x(), own.z());
    };
    check(loads.modal_acceleration.col(mode), shape);
    check(loads.turned_acceleration.col(mode), [&](const fem::BeamElement& element, int e, double xi) {
      const Eigen::Vector3d motion = shape(element, e, xi);
      return Eigen::Vector3d(-motion.y(), motion.x(), 0.0);
    });
  }
}

TEST_CASE("on a closed frame section loads and deflections of a point are the sum over all modes") {
  // Statically indeterminate; all modes together are the finite element solution, found another way.
  fem::BeamModel model = testing::make_spoked_square(0.3);
  model.mesh.named_nodes = {
      {.name = "corner", .node = testing::find_node_at(model, model.mesh.node_positions.col(3))},
      {.name = "other", .node = 7}};
  const Superelement body = make_superelement(testing::make_design(model, {0.0, 0.0}, {}));
  REQUIRE(body.num_modes() == body.num_elastic_dofs);
  const Eigen::LLT<Eigen::MatrixXd> stiffness(body.stiffness);
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const Eigen::MatrixXd shapes = body.shapes.middleRows(3 * body.points[p].node, 3);
    const Eigen::MatrixXd expected = body.resultants * stiffness.solve(shapes.transpose());
    const Eigen::MatrixXd found =
        body.section_loads->point_load.middleCols(3 * static_cast<Eigen::Index>(p), 3);
    CHECK((found - expected).cwiseAbs().maxCoeff() < kTolerance * expected.cwiseAbs().maxCoeff());
    const Eigen::MatrixXd flexibility = shapes * stiffness.solve(shapes.transpose());
    const auto row = 3 * static_cast<Eigen::Index>(p);
    CHECK((body.point_deflections->point_load.block(row, row, 3, 3) - flexibility).cwiseAbs().maxCoeff() <
          kTolerance * flexibility.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("a frame with too many elements for its responses has none, and no others") {
  fem::BeamModel model = testing::make_model();
  testing::add_line(model, {0.0, 0.0}, {1.0, 0.0}, 4);
  const Eigen::Index m = 1 + kMostResponseValues / (6 * 4 * 2);  // as many modes: shapes of zeros do
  const fem::AssembledMatrices matrices = fem::assemble(model);
  CHECK_FALSE(calc_static_response(model, 0, StiffnessFactor(testing::make_modal_problem(model, 0).stiffness),
                                   matrices.mass, fem::calc_mass_moments(model, Eigen::Vector2d::Zero()),
                                   Eigen::MatrixXd::Zero(15, m)));
}

}  // namespace
}  // namespace sprung::reduce

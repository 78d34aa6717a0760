#include "reduce/reduction/inertia_invariants.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "fem/assembly.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/fem/rigid_motions.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

// An L with shear, rotary inertia and point masses, no coordinate zero, held inside.
fem::BeamModel make_frame() {
  fem::BeamModel model = testing::make_model({testing::make_section(true)});
  testing::add_line(model, {0.3, -0.2}, {1.5, 0.4}, 4);
  testing::add_line(model, {1.5, 0.4}, {1.1, 1.7}, 3);
  model.point_masses = {{.node = 0, .mass = 2.1, .inertia = 0.04}, {.node = 6, .mass = 0.7, .inertia = 0.02}};
  return model;
}

struct Case {
  fem::BeamModel model = make_frame();
  Eigen::Vector2d origin = model.mesh.node_positions.col(2);
  fem::MassMoments moments = fem::calc_mass_moments(model, origin);
  Superelement s = make_superelement(testing::make_design(model, origin, {.wanted = ModeCount{7}}));
};

TEST_CASE("the invariants are the projections of the consistent mass") {
  const Case c;
  const Eigen::SparseMatrix<double> M = fem::assemble(c.model).mass;
  const Eigen::MatrixXd R = fem::test::calc_rigid_motions(c.model.mesh, c.origin);
  const InertiaInvariants& inertia = c.s.inertia;
  Eigen::MatrixXd all(R.rows(), 3 + c.s.num_modes());
  all << R, c.s.shapes;
  const Eigen::MatrixXd expected = all.transpose() * (M * all);
  const Eigen::MatrixXd mass = calc_mass_matrix(inertia);
  CHECK((mass - expected).cwiseAbs().maxCoeff() < 1e-13 * expected.cwiseAbs().maxCoeff());
  CHECK((inertia.M_ff - Eigen::MatrixXd::Identity(7, 7)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a modal displacement that equals a rigid turn has the invariants of the turned body") {
  // Shapes: translations, and the linear part of a turn about the origin. For the field (x, y)(cos θ − 1) of
  // a finite turn the positions are linear in the "amplitudes" below, so that the moments of the moved body
  // follow exactly.
  const Case c;
  Eigen::MatrixXd shapes = fem::test::calc_rigid_motions(c.model.mesh, c.origin);
  const InertiaInvariants inertia = calc_inertia_invariants(c.moments, shapes);
  CHECK(inertia.P(0, 0) == Approx(inertia.mass));
  CHECK(inertia.P(1, 1) == Approx(inertia.mass));
  CHECK(
      inertia.P.col(2).isApprox(Eigen::Vector2d(-inertia.first_moment.y(), inertia.first_moment.x()), 1e-13));
  CHECK(inertia.c(2) == Approx(inertia.second_moment));
  CHECK(inertia.d(2) == Approx(0.0).margin(1e-13));
  CHECK(inertia.d(0) == Approx(inertia.first_moment.x()));
  CHECK(inertia.B(0, 1) == Approx(inertia.mass));
  CHECK(inertia.B(0, 2) == Approx(inertia.first_moment.x()));
  CHECK(inertia.B(1, 2) == Approx(inertia.first_moment.y()));

  // J about the origin after shifting the body by (a, b), with the rotary part left as it is: J₀ + 2 d η +
  // ηᵀ(…)η.
  const Eigen::Vector3d eta(0.37, -0.21, 0.0);
  const double quadratic = eta.dot((inertia.phi_x_phi_x + inertia.phi_y_phi_y) * eta);
  const double shifted = inertia.second_moment + 2.0 * inertia.d * eta + quadratic;
  const fem::MassMoments moved = fem::calc_mass_moments(c.model, c.origin - eta.head<2>());
  CHECK(shifted == Approx(moved.second_moment()).epsilon(1e-13));
}

TEST_CASE("J₀ + 2dη + ηᵀ(M_xx + M_yy)η is the moment of inertia of the deformed axis, by fine quadrature") {
  // Simpson's rule over 400 panels of each element, from the shape functions and point masses alone.
  const Case c;
  Eigen::VectorXd eta(7);
  eta << 0.31, -0.22, 0.17, 0.08, -0.05, 0.11, 0.02;
  const Eigen::VectorXd q = c.s.shapes * eta;
  double J = 0.0, c_eta = 0.0;
  Eigen::Vector2d P_eta = Eigen::Vector2d::Zero();
  const auto add = [&](double dm, const Eigen::Vector2d& r, const Eigen::Vector2d& u) {
    J += dm * (r + u).squaredNorm();
    c_eta += dm * (r.x() * u.y() - r.y() * u.x());
    P_eta += dm * u;
  };
  constexpr int kPanels = 400;
  for (int e = 0; e < c.model.mesh.num_elements(); ++e) {
    const fem::BeamElement element = fem::make_element(c.model, e);
    const fem::Mesh::Element& nodes = c.model.mesh.elements[static_cast<std::size_t>(e)];
    const double length = (element.second - element.first).norm();
    const Eigen::Vector2d t = (element.second - element.first) / length, n(-t.y(), t.x());
    Eigen::Matrix<double, 6, 1> ends;
    ends << q.segment<3>(3 * nodes.first), q.segment<3>(3 * nodes.second);
    const Eigen::Matrix<double, 6, 1> own = fem::calc_rotation(element) * ends;
    for (int i = 0; i <= kPanels; ++i) {
      const double xi = static_cast<double>(i) / kPanels;
      const double weight = (i == 0 || i == kPanels ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0)) / (3.0 * kPanels);
      const Eigen::Vector3d field = fem::calc_shape_functions(length, element.properties, xi) * own;
      add(weight * length * element.properties.mass_per_length, element.first + xi * length * t - c.origin,
          field(0) * t + field(1) * n);
      J += weight * length * element.properties.rotary_inertia;
      c_eta += weight * length * element.properties.rotary_inertia * field(2);
    }
  }
  for (const fem::PointMass& point : c.model.point_masses) {
    add(point.mass, c.model.mesh.node_positions.col(point.node) - c.origin, q.segment<2>(3 * point.node));
    J += point.inertia;
    c_eta += point.inertia * q(3 * point.node + 2);
  }
  const InertiaInvariants& inertia = c.s.inertia;
  const double quadratic = eta.dot((inertia.phi_x_phi_x + inertia.phi_y_phi_y) * eta);
  CHECK(inertia.second_moment + 2.0 * inertia.d * eta + quadratic == Approx(J).epsilon(1e-10));
  CHECK(inertia.c * eta == Approx(c_eta).epsilon(1e-10));
  CHECK((inertia.P * eta - P_eta).norm() < 1e-10 * P_eta.norm());
}

TEST_CASE("B is the angular momentum of one mode's motion on another's displacement") {
  const Case c;
  const InertiaInvariants& inertia = c.s.inertia;
  const Eigen::MatrixXd NxNy = c.s.shapes.transpose() * (c.moments.NxNy * c.s.shapes);
  CHECK((inertia.B - (NxNy - NxNy.transpose())).cwiseAbs().maxCoeff() < 1e-13);
  CHECK(inertia.B.cwiseAbs().maxCoeff() > 0.1);  // this frame's modes have displacements in both directions
  CHECK((inertia.B + inertia.B.transpose()).cwiseAbs().maxCoeff() == 0.0);
}

TEST_CASE("the mass matrix of frame and all modes is positive definite and keeps the body's total mass") {
  const Case c;
  const Superelement all = make_superelement(testing::make_design(c.model, c.origin, {}));
  const Eigen::MatrixXd mass = calc_mass_matrix(all.inertia);
  CHECK(mass == mass.transpose());
  // With every freedom present the determinant is that of the free frame's mass in the same coordinates.
  Eigen::MatrixXd basis(3 * c.model.mesh.num_nodes(), 3 + all.num_modes());
  basis << fem::test::calc_rigid_motions(c.model.mesh, c.origin), all.shapes;
  const Eigen::MatrixXd inverse = basis.inverse();
  const Eigen::MatrixXd full = inverse.transpose() * mass * inverse;
  CHECK((full - Eigen::MatrixXd(fem::assemble(c.model).mass)).cwiseAbs().maxCoeff() <
        1e-9 * full.cwiseAbs().maxCoeff());
}

TEST_CASE("shapes of another frame are refused") {
  const Case c;
  CHECK_THAT(testing::message_of<std::invalid_argument>(
                 [&] { calc_inertia_invariants(c.moments, Eigen::MatrixXd::Zero(5, 2)); }),
             Contains("has 5 rows, expected 24"));
}

}  // namespace
}  // namespace sprung::reduce

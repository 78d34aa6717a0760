#include "fem/assembly.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tests/fem/rigid_motions.h"

namespace sprung::fem {

namespace {
constexpr double kRounding = 1e-13;  // relative, of sums over a few elements
}

TEST_CASE("A general frame's rigid motions store no energy") {
  const BeamModel model = test::make_general_frame();
  const Eigen::MatrixXd K = assemble(model).stiffness;
  const Eigen::MatrixXd force = K * test::calc_rigid_motions(model.mesh, {-0.7, 2.3});
  CHECK(force.lpNorm<Eigen::Infinity>() < kRounding * K.lpNorm<Eigen::Infinity>());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(K, Eigen::EigenvaluesOnly);
  CHECK(modes.eigenvalues()[3] > 1e-6 * modes.eigenvalues().maxCoeff());  // and only they
}

TEST_CASE("A general frame's rigid motions carry its exact mass, first moment and inertia") {
  const BeamModel model = test::make_general_frame();
  const Eigen::Vector2d origin(-0.7, 2.3);
  double mass = 0.0, inertia = 0.0;
  Eigen::Vector2d first_moment = Eigen::Vector2d::Zero();
  const auto add = [&](double m, double J, const Eigen::Vector2d& r) {
    mass += m;
    first_moment += m * r;
    inertia += J + m * r.squaredNorm();
  };
  for (const Mesh::Element& element : model.mesh.elements) {  // bars: ρAL³/12 + ρIL about their middle
    const BeamProperties& section = model.sections[static_cast<std::size_t>(element.section)];
    const Eigen::Vector2d a = model.mesh.node_positions.col(element.first);
    const Eigen::Vector2d b = model.mesh.node_positions.col(element.second);
    const double L = std::hypot(b.x() - a.x(), b.y() - a.y());
    add(section.mass_per_length * L, section.mass_per_length * L * L * L / 12.0 + section.rotary_inertia * L,
        0.5 * (a + b) - origin);
  }
  for (const PointMass& point : model.point_masses) {
    add(point.mass, point.inertia, model.mesh.node_positions.col(point.node) - origin);
  }
  Eigen::Matrix3d expected;
  expected << mass, 0, -first_moment.y(),  //
      0, mass, first_moment.x(),           //
      -first_moment.y(), first_moment.x(), inertia;
  const Eigen::MatrixXd R = test::calc_rigid_motions(model.mesh, origin);
  CHECK(test::calc_difference(R.transpose() * (assemble(model).mass * R), expected) < kRounding);
}

TEST_CASE("Assembled matrices are exactly symmetric, and couple connected nodes only") {
  const AssembledMatrices assembled = assemble(test::make_general_frame());
  for (const Eigen::MatrixXd& matrix :
       {Eigen::MatrixXd(assembled.stiffness), Eigen::MatrixXd(assembled.mass)}) {
    CHECK(matrix.rows() == 15);
    CHECK(matrix == matrix.transpose());
    CHECK(matrix.block<3, 3>(0, 9).isZero(0.0));  // nodes 0 and 3 have no element in common
    CHECK(matrix.block<3, 3>(6, 12).isZero(0.0));
    CHECK(!matrix.block<3, 3>(0, 3).isZero(0.0));
  }
}

TEST_CASE("Point masses on one node add up, on the diagonal alone") {
  BeamModel model = test::make_general_frame();
  const Eigen::MatrixXd before = assemble(model).mass;
  model.point_masses.push_back({.node = 4, .mass = 2.1, .inertia = 0.09});
  const Eigen::MatrixXd added = Eigen::MatrixXd(assemble(model).mass) - before;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(15, 15);
  expected.diagonal().tail<3>() << 2.1, 2.1, 0.09;
  CHECK(test::calc_difference(added, expected) < 1e-12);
}

TEST_CASE("Renumbering the nodes permutes the matrices") {
  const std::vector<int> order = {2, 4, 1, 0, 3};
  const BeamModel model = test::make_general_frame();
  const AssembledMatrices a = assemble(model), b = assemble(test::renumber(model, order));
  std::vector<Eigen::Index> dofs;
  for (const int node : order) {
    for (int i = 0; i < 3; ++i) dofs.push_back(3 * node + i);
  }
  CHECK(test::calc_difference(Eigen::MatrixXd(b.stiffness)(dofs, dofs), a.stiffness) < 1e-15);
  CHECK(test::calc_difference(Eigen::MatrixXd(b.mass)(dofs, dofs), a.mass) < 1e-15);
}

TEST_CASE("An inconsistent model is refused, naming what is wrong") {
  const auto message = [](auto&& spoil) {
    BeamModel model = test::make_general_frame();
    spoil(model);
    return test::message_of<std::invalid_argument>([&] { assemble(model); });
  };
  test::check_contains(message([](BeamModel& m) { m.sections.pop_back(); }),
                       "assemble: sections has 1 entries, expected 2");
  test::check_contains(message([](BeamModel& m) { m.sections[1].axial_rigidity = -1.0; }),
                       "axial_rigidity is -1");
  test::check_contains(message([](BeamModel& m) { m.mesh.elements[2].second = 5; }),
                       "element 2 has nodes 2 and 5, expected 0 … 4");
  test::check_contains(message([](BeamModel& m) { m.mesh.elements[3].section = -1; }),
                       "element 3 has section -1, expected 0 … 1");
  test::check_contains(message([](BeamModel& m) { m.mesh.named_nodes[0].node = 9; }), "'corner' is node 9");
  test::check_contains(message([](BeamModel& m) { m.mesh.node_ids.pop_back(); }),
                       "node_positions has 5 columns, expected 4");
  test::check_contains(message([](BeamModel& m) { m.point_masses[1].node = 5; }),
                       "point mass at node 5, expected 0 … 4");
  test::check_contains(message([](BeamModel& m) { m.point_masses[0].mass = std::nan(""); }),
                       "point mass is nan kg");
  test::check_contains(message([](BeamModel& m) { m.point_masses[0].inertia = -0.1; }),
                       "inertia of a point mass is -0.1 kg·m²");
}

}  // namespace sprung::fem

#include "fem/spread_loads.h"

#include <Eigen/LU>

#include "fem/mass_moments.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {
namespace {

TEST_CASE("the turned mass of the elements adds up to the mass moments' NyNx − NxNy") {
  // Both are sums over Gauss points, one in the elements' axes, the other in the mesh's. Point masses stand
  // at nodes, in the second only: without them.
  BeamModel model = test::make_general_frame();
  model.point_masses.clear();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * model.mesh.num_nodes(), 3 * model.mesh.num_nodes());
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const Matrix6 turned = calc_turned_mass(make_element(model, e));
    const int first[] = {3 * nodes.first, 3 * nodes.second};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) sum.block(first[i], first[j], 3, 3) += turned.block(3 * i, 3 * j, 3, 3);
    }
  }
  const Eigen::MatrixXd NxNy = calc_mass_moments(model, {0.3, -0.4}).NxNy;
  CHECK(test::calc_difference(sum, NxNy.transpose() - NxNy) < 1e-13);
}

TEST_CASE("a cantilever of one element under its weight has the exact force and moment at its root") {
  // Held at its first end, the load p per length across and q along: M = p L²/2, Q = p L, N = q L at the
  // root, nothing at the tip.
  const Eigen::Vector2d from(0.4, -0.3), t(0.8, 0.6), n(-0.6, 0.8);
  const double length = 2.5, p = 3.0, q = -1.5;
  for (const BeamProperties& properties : {test::make_thin_properties(), test::make_thick_properties()}) {
    const BeamElement beam{.first = from, .second = from + length * t, .properties = properties};
    const Eigen::Vector2d acceleration = -(p * n + q * t) / properties.mass_per_length;
    Eigen::Matrix<double, 6, 1> motion;
    motion << acceleration, 0.0, acceleration, 0.0;
    const Eigen::Matrix<double, 6, 1> load = -calc_mass(beam) * motion;
    Eigen::Matrix<double, 6, 1> ends = Eigen::Matrix<double, 6, 1>::Zero();
    ends.tail<3>() = calc_stiffness(beam).bottomRightCorner<3, 3>().inverse() * load.tail<3>();
    const Eigen::VectorXd resultants = calc_loaded_resultants(beam, ends, load);
    CHECK(resultants(0) == Approx(q * length));
    CHECK(resultants(1) == Approx(p * length));
    CHECK(resultants(2) == Approx(0.5 * p * length * length));
    CHECK(resultants.tail(3).cwiseAbs().maxCoeff() < 1e-12);
  }
}

}  // namespace
}  // namespace sprung::fem

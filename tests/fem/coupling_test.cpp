#include "fem/coupling.h"

#include <stdexcept>

#include "fem/assembly.h"
#include "fem/mass_moments.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tests/fem/rigid_motions.h"

namespace sprung::fem {

namespace {

constexpr double kRounding = 1e-12;  // relative, of sums over a few elements

// Five nodes; a beam ends at one that follows three others, and a mass hangs at one that follows its
// neighbour.
BeamModel make_free_model() {
  BeamModel model;
  model.mesh.node_ids = {1, 2, 3, 4, 5};
  model.mesh.node_positions.resize(2, 5);
  model.mesh.node_positions << 0.0, 1.1, 2.0, 2.4, 0.7,  //
      0.0, 0.2, 0.1, 0.9, 0.8;
  model.mesh.section_names = {"bar", "bushing"};
  BeamProperties bushing{.axial_rigidity = 1.0, .bending_rigidity = 1.0};
  bushing.bushing =
      Bushing{.stiffness = Eigen::Matrix3d{{3.0, 1.0, 0.0}, {1.0, 2.0, 0.0}, {0.0, 0.0, 0.0}}, .place = 0.3};
  model.sections = {test::make_thick_properties(), bushing};
  model.mesh.elements = {{0, 1, 0}, {1, 2, 0}, {0, 2, 1}, {2, 4, 0}};
  model.point_masses = {{.node = 3, .mass = 2.0, .inertia = 0.4}};
  return model;
}

BeamModel make_coupled_model() {
  BeamModel model = make_free_model();
  const Eigen::Matrix2Xd& places = model.mesh.node_positions;
  model.couplings = {make_rigid_offset(places, 3, 2), make_average(places, 4, {0, 1, 2}, {1.0, 2.0, 0.5})};
  return model;
}

}  // namespace

TEST_CASE("Followers move rigidly with the nodes that they follow") {
  const BeamModel model = make_coupled_model();
  const Eigen::MatrixXd R = test::calc_rigid_motions(model.mesh, Eigen::Vector2d::Zero());
  Eigen::MatrixXd without = R;
  without.bottomRows(6).setZero();
  CHECK((move_followers(model.couplings, without) - R).norm() < kRounding * R.norm());
}

TEST_CASE("Eliminating followers keeps the mass of rigid motions, and the energy of all others") {
  const BeamModel model = make_coupled_model();
  const AssembledMatrices coupled = assemble(model), free = assemble(make_free_model());
  const Eigen::MatrixXd R = test::calc_rigid_motions(model.mesh, Eigen::Vector2d::Zero());
  const Eigen::Matrix3d expected = R.transpose() * free.mass * R, found = R.transpose() * coupled.mass * R;
  CHECK((found - expected).norm() < kRounding * expected.norm());

  Eigen::MatrixXd q = Eigen::VectorXd::LinSpaced(15, -0.7, 1.3);
  q.bottomRows(6).setZero();
  const Eigen::MatrixXd u = move_followers(model.couplings, q);
  for (const auto& [one, other] :
       {std::pair(&coupled.stiffness, &free.stiffness), std::pair(&coupled.mass, &free.mass)}) {
    const double energy = (u.transpose() * (*other * u))(0);
    CHECK((q.transpose() * (*one * q))(0) == Approx(energy).epsilon(kRounding));
  }
  CHECK(Eigen::MatrixXd(coupled.mass).bottomRows(6).norm() == 0.0);
  CHECK((Eigen::MatrixXd(coupled.stiffness) - Eigen::MatrixXd(coupled.stiffness).transpose()).norm() == 0.0);
}

// The quadrature of the moments against the closed form of the mass (fem, eq. 20).
TEST_CASE("The mass moments of a frame with followers add up to its mass") {
  const BeamModel model = make_coupled_model();
  const MassMoments moments = calc_mass_moments(model, {0.1, 0.2});
  const Eigen::MatrixXd mass = Eigen::MatrixXd(assemble(model).mass);
  const Eigen::MatrixXd sum =
      Eigen::MatrixXd(moments.NxNx) + Eigen::MatrixXd(moments.NyNy) + Eigen::MatrixXd(moments.rotary_NN);
  CHECK((sum - mass).norm() < kRounding * mass.norm());
  const Eigen::VectorXd along = test::calc_rigid_motions(model.mesh, Eigen::Vector2d::Zero()).col(0);
  CHECK(moments.N_x.dot(along) == Approx(moments.mass).epsilon(kRounding));
}

TEST_CASE("Loads moved to leaders do the same work") {
  const BeamModel model = make_coupled_model();
  const Eigen::MatrixXd q = Eigen::VectorXd::LinSpaced(15, -0.7, 1.3),
                        f = Eigen::VectorXd::LinSpaced(15, 2.0, -3.1);
  const double work = (f.transpose() * move_followers(model.couplings, q))(0);
  const double moved = (move_loads_to_leaders(model.couplings, f).transpose() * q)(0);
  CHECK(moved == Approx(work).epsilon(kRounding));
}

TEST_CASE("An average needs two leaders, and weights that are positive") {
  const Eigen::Matrix2Xd places = make_free_model().mesh.node_positions;
  CHECK_THROWS_AS(make_average(places, 4, {0}, {1.0}), std::invalid_argument);
  CHECK_THROWS_AS(make_average(places, 4, {0, 1}, {1.0}), std::invalid_argument);
  CHECK_THROWS_AS(make_average(places, 4, {0, 1}, {1.0, 0.0}), std::invalid_argument);
}

}  // namespace sprung::fem

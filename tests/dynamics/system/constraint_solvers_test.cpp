// Multipliers and dependents on mechanisms with several kinds of joints, against dense algebra.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <memory>
#include <vector>

#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/system/dependent_solver.h"
#include "dynamics/system/multiplier_solver.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void add_joint(dynamics::Model& model, int a, int b, dynamics::CoordinateJoint::Parts parts) {
  model.joints.push_back(std::make_shared<dynamics::CoordinateJoint>(
      "joint", a, b, support::SourceLocation{"vehicle.toml", 1, 1}, std::move(parts)));
}

// Joints of one, two and three constraints, on rigid and flexible bodies and the ground; a link holds two
// nodes of one body together.
struct Assembly {
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 8);
  dynamics::Model model;

  Assembly() {
    const reduce::Superelement& s = frame.superelement;
    const int first = test::add_body(model, dynamics::make_flexible_body("first", s, {1, 2, 3, 5, 8}));
    const int bar = test::add_body(model, dynamics::make_rigid_body("bar", 12.0, 3.0));
    const int last = test::add_body(model, dynamics::make_flexible_body("last", s, {2, 4}));
    test::add_pin(model, "post", test::add_marker(model, dynamics::kGround, {0.3, 0.2}),
                  test::add_node_marker(model, first, s, 2));
    add_joint(model, test::add_node_marker(model, first, s, 4, {0.1, -0.2}),
              test::add_marker(model, bar, {0.0, 0.4}), dynamics::make_fixed_joint(0.3));
    add_joint(model, test::add_marker(model, bar, {0.2, -0.3}), test::add_node_marker(model, last, s, 1),
              dynamics::make_distance_joint(dynamics::TimeFunction(0.7)));
    add_joint(model, test::add_node_marker(model, first, s, 3), test::add_node_marker(model, first, s, 1),
              dynamics::make_distance_joint(dynamics::TimeFunction(0.5)));
    add_joint(model, test::add_marker(model, bar, {-0.4, 0.1}), test::add_node_marker(model, last, s, 3),
              dynamics::make_translational_joint({0.6, 0.8}, 0.0));
    dynamics::number_model(model);
  }
};

}  // namespace

TEST_CASE("Multipliers are those of the dense matrix, for several kinds of joints", "[system]") {
  const Assembly assembly;
  const dynamics::Model& model = assembly.model;
  REQUIRE(model.num_constraints == 9);
  dynamics::SystemTerms terms(model);
  dynamics::MultiplierSolver solver(terms.jacobian(), model.num_constraints);
  test::RandomNumbers random(17);
  for (int i = 0; i < 20; ++i) {
    terms.update_positions(0.0, random.vector(model.num_coordinates, 1.0));
    terms.update_jacobian();
    terms.update_mass();
    MatrixXd mass = MatrixXd::Zero(model.num_coordinates, model.num_coordinates);
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const dynamics::Body& body = model.bodies[b];
      mass.block(body.first_coordinate, body.first_coordinate, body.num_coordinates(),
                 body.num_coordinates()) = terms.mass(b);
    }
    const MatrixXd Phi_q = terms.jacobian().dense();
    const MatrixXd matrix = Phi_q * mass.llt().solve(Phi_q.transpose());
    const VectorXd r = random.vector(model.num_constraints, 1.0);
    VectorXd lambda(model.num_constraints);
    REQUIRE(solver.factorise(terms.jacobian(), terms.masses()));
    solver.solve(r, lambda);
    CHECK((matrix * lambda - r).norm() < 1e-12 * matrix.norm() * lambda.norm());
  }
}

TEST_CASE("A constraint between points of the ground makes the multipliers' matrix singular", "[system]") {
  Assembly assembly;
  test::add_pin(assembly.model, "in the ground",
                test::add_marker(assembly.model, dynamics::kGround, {0.3, 0.2}),
                test::add_marker(assembly.model, dynamics::kGround, {0.3, 0.2}));
  dynamics::number_model(assembly.model);
  dynamics::SystemTerms terms(assembly.model);
  terms.update_positions(0.0, test::RandomNumbers(3).vector(assembly.model.num_coordinates, 1.0));
  terms.update_jacobian();
  terms.update_mass();
  dynamics::MultiplierSolver solver(terms.jacobian(), assembly.model.num_constraints);
  CHECK_FALSE(solver.factorise(terms.jacobian(), terms.masses()));
}

TEST_CASE("The Jacobian that is made once for joints of constant rows is that of any position", "[system]") {
  const Assembly assembly;
  const dynamics::Model& model = assembly.model;
  CHECK(model.joints[0]->has_constant_jacobian());  // pin
  CHECK(model.joints[1]->has_constant_jacobian());  // fixed
  CHECK_FALSE(model.joints[2]->has_constant_jacobian());
  CHECK_FALSE(model.joints[4]->has_constant_jacobian());
  dynamics::SystemTerms terms(model);
  test::RandomNumbers random(23);
  const VectorXd q = random.vector(model.num_coordinates, 1.0),
                 direction = random.vector(model.num_coordinates, 1.0);
  constexpr double kShift = 1e-6;
  const auto residual = [&](double shift) {
    VectorXd phi(model.num_constraints);
    terms.update_positions(0.0, q + shift * direction);
    terms.calc_residual(phi);
    return phi;
  };
  const VectorXd difference = (residual(kShift) - residual(-kShift)) / (2.0 * kShift);
  terms.update_positions(0.0, q);
  terms.update_jacobian();
  CHECK((terms.jacobian().dense() * direction - difference).norm() < 1e-8 * difference.norm());
}

TEST_CASE("Dependents and products with independents are those of the dense Jacobian", "[system]") {
  const Assembly assembly;
  const dynamics::Model& model = assembly.model;
  dynamics::SystemTerms terms(model);
  test::RandomNumbers random(29);
  terms.update_positions(0.0, random.vector(model.num_coordinates, 1.0));
  terms.update_jacobian();
  terms.update_mass();
  const dynamics::Partition partition = dynamics::choose_partition(terms);
  dynamics::DependentSolver solver(terms.jacobian(), partition, model.num_coordinates);
  solver.factorise(terms.jacobian());
  const MatrixXd Phi_q = terms.jacobian().dense();
  const MatrixXd Phi_d = Phi_q(Eigen::all, partition.dependent),
                 Phi_i = Phi_q(Eigen::all, partition.independent);
  const VectorXd x_i = random.vector(model.num_freedoms(), 1.0),
                 r = random.vector(model.num_constraints, 1.0);
  VectorXd sum = r, x_d(model.num_constraints);
  solver.add_independent_product({x_i.data(), static_cast<std::size_t>(x_i.size())}, sum);
  CHECK((sum - r - Phi_i * x_i).norm() < 1e-14 * Phi_i.norm() * x_i.norm());
  solver.solve(r, x_d);
  CHECK((Phi_d * x_d - r).norm() < 1e-13 * Phi_d.norm() * x_d.norm());

  VectorXd used = r, y(model.num_constraints), product = x_i;
  solver.solve_transposed(used, y);
  CHECK((Phi_d.transpose() * y - r).norm() < 1e-13 * Phi_d.norm() * y.norm());
  solver.subtract_transposed_product(y, {product.data(), static_cast<std::size_t>(product.size())});
  CHECK((product - x_i + Phi_i.transpose() * y).norm() < 1e-14 * Phi_i.norm() * y.norm());
}

TEST_CASE("Columns of the reduced mass are those of the whole matrix", "[system]") {
  const Assembly assembly;
  dynamics::PartitionedEquations equations(assembly.model);
  equations.choose_partition_at(0.0, test::RandomNumbers(31).vector(assembly.model.num_coordinates, 1.0));
  equations.update_mass();
  const std::vector<int> freedoms{4, 0, 2};
  MatrixXd columns;
  equations.calc_mass_columns(freedoms, columns);
  const MatrixXd whole = equations.calc_reduced_mass(equations.calc_directions());
  CHECK((columns - whole(Eigen::all, freedoms)).norm() < 1e-13 * whole.norm());
}

TEST_CASE("Dependents with a singular Jacobian have no solution", "[system]") {
  // Both rows are of the first coordinate alone; the second stands in the pattern, but is always zero.
  dynamics::BlockJacobian jacobian(2, 3);
  const std::size_t block =
      jacobian.add_block({.row = 0, .num_rows = 2, .column = 0, .num_columns = 3, .body = 0});
  for (int i = 0; i < 2; ++i) {
    jacobian.mark_zero(block, i, 1);
    jacobian.values(block)[3 * i] = 1.0 + i;
  }
  dynamics::DependentSolver solver(jacobian, {.independent = {2}, .dependent = {0, 1}}, 3);
  solver.factorise(jacobian);
  VectorXd x = VectorXd::Zero(2);
  solver.solve(VectorXd::Ones(2), x);
  CHECK_FALSE(x.allFinite());
  VectorXd r = VectorXd::Ones(2);
  solver.solve_transposed(r, x);
  CHECK_FALSE(x.allFinite());
}

#include "reduce/basis/fixed_interface_basis.h"

#include <Eigen/Dense>
#include <cmath>

#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/coupled_vehicle.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {
namespace {

using testing::message_of;

Design make_fixed(std::uint64_t seed) {
  Design design = testing::make_random_design(seed, 0.01);
  design.reduction.basis = BasisKind::kFixedInterface;
  return design;
}

// Constraint modes hold the response to every interface displacement, and so to interface loads in
// equilibrium. The inertia of the whole body, which balances other loads, they hold only in part. Expected by
// the full model.
TEST_CASE("a basis of fixed interface is exact at rest under loads in equilibrium") {
  for (const std::uint64_t seed : {0, 2, 3, 5}) {
    const Design design = make_fixed(seed);
    const Superelement body = make_superelement(design);
    const Eigen::MatrixXd expected =
        testing::FreeBodyTruth(design.model).calc_flexibility_at_rest(design.reduction.interface);
    const Eigen::MatrixXd found = testing::calc_flexibility(body, 0.0);
    const testing::FreeBodyTruth truth(design.model);
    Eigen::MatrixXd resultants(3, expected.rows());  // of unit loads
    for (Eigen::Index j = 0; j < expected.rows(); ++j) {
      const InterfaceFreedom& one = design.reduction.interface[static_cast<std::size_t>(j)];
      resultants.col(j) = truth.rigid().row(3 * one.node + one.freedom).transpose();
    }
    const Eigen::MatrixXd balanced = resultants.fullPivLu().kernel();
    const Eigen::MatrixXd found_balanced = balanced.transpose() * found * balanced;
    const Eigen::MatrixXd expected_balanced = balanced.transpose() * expected * balanced;
    const Eigen::VectorXd scale = expected_balanced.diagonal().cwiseSqrt().cwiseInverse();
    CHECK((scale.asDiagonal() * (found_balanced - expected_balanced) * scale.asDiagonal())
              .cwiseAbs()
              .maxCoeff() < 1e-9);
    const auto num_constraint = static_cast<int>(design.reduction.interface.size()) - 3;
    CHECK(body.num_modes() >= num_constraint);
    for (const CheckResult& check : body.checks) {
      INFO(check.name);
      CHECK(check.passed());
    }
    for (int i = 0; i < body.num_modes(); ++i) {
      CHECK((body.kind_of(i) == kConstraintVector || body.kind_of(i) == kFixedInterfaceVector));
    }
  }
}

TEST_CASE("an interface that does not hold the body is refused") {
  Design design = make_fixed(0);
  design.reduction.interface.resize(2);
  design.reduction.where = {.path = "design.toml", .line = 3, .column = 1};
  const std::string message = message_of<support::InputError>([&] { make_superelement(design); });
  CHECK_THAT(message, Contains("design.toml:3:1: error: basis \"fixed-interface\": the interface freedoms do "
                               "not hold the body"));
}

// Two halves of a beam of 4 m, each with its reference at its middle. Expected: the full model of the whole
// beam.
TEST_CASE(
    "two half beams welded have the frequencies of the whole with 8 vectors each, by free or fixed "
    "interface") {
  fem::BeamModel half = testing::make_model();
  testing::add_line(half, {0.0, 0.0}, {2.0, 0.0}, 16);
  fem::BeamModel whole = testing::make_model();
  testing::add_line(whole, {0.0, 0.0}, {4.0, 0.0}, 32);
  const Eigen::VectorXd expected = testing::FreeBodyTruth(whole).calc_frequencies();
  const auto make_half = [&](double weld_at, BasisKind basis) {
    fem::BeamModel model = half;
    const auto interface = testing::make_interface(model, {testing::find_node_at(model, {weld_at, 0.0})});
    Design design = testing::make_design(model, {1.0, 0.0}, {});
    // Modes of the held body converge by their number alone: they get a band eight times as wide.
    const double highest_hz = (basis == BasisKind::kFree ? 1.05 : 8.4) * expected(2);
    design.reduction = {.basis = basis, .highest_hz = highest_hz, .tolerance = 1e-3, .interface = interface};
    const Superelement body = make_superelement(design);
    CHECK(body.num_modes() <= 8);
    return testing::make_reduced_body(body, interface);
  };
  for (const BasisKind basis : {BasisKind::kFree, BasisKind::kFixedInterface}) {
    testing::CoupledBody first = make_half(2.0, basis), second = make_half(0.0, basis);
    const Eigen::VectorXd found = testing::calc_frequencies(testing::weld(first, second));
    for (Eigen::Index i = 0; i < 3; ++i) CHECK(std::abs(found(i) / expected(i) - 1.0) < 1e-4);
  }
}

// A vehicle does not know the basis of a body, if that holds all its motions. Truth: the full model.
TEST_CASE("all vectors of each basis, and clamped at five places, give one vehicle") {
  const testing::LadderFrame ladder = [] {
    testing::LadderFrame frame = testing::make_ladder_frame();
    return frame;
  }();
  const Eigen::VectorXd expected = testing::calc_frequencies(testing::make_ladder_vehicle(ladder));
  const auto check = [&](const Design& design) {
    const Superelement body = make_superelement(design);
    REQUIRE(body.num_modes() == body.num_elastic_dofs);
    const Eigen::VectorXd found = testing::calc_frequencies(testing::make_ladder_vehicle(ladder, body));
    for (Eigen::Index i = 0; i < 12; ++i) CHECK(std::abs(found(i) / expected(i) - 1.0) < 1e-9);
  };
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(3, 0), Eigen::Vector2d(0, 0), Eigen::Vector2d(6, 0.8),
                                       Eigen::Vector2d(2, 0.8), Eigen::Vector2d(5, 0)}) {
    check(testing::make_design(ladder.model, place, {.wanted = AllModes{}}));
  }
  for (const BasisKind basis : {BasisKind::kFree, BasisKind::kFixedInterface}) {
    Design design = testing::make_design(ladder.model, ladder.reference, {});
    design.reduction = {.basis = basis, .highest_hz = 1e7, .interface = ladder.interface};
    check(design);
  }
}

}  // namespace
}  // namespace sprung::reduce

#include "reduce/basis/free_basis.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <numeric>

#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/coupled_vehicle.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {
namespace {

using testing::FreeBodyTruth;

int count_kind(const Superelement& body, const char* kind) {
  int number = 0;
  for (const std::string& one : body.kind) number += one == kind ? 1 : 0;
  return number;
}

TEST_CASE("a free basis holds the free modes below 1.5 times the band, then residual vectors above them") {
  for (const std::uint64_t seed : {0, 1, 4, 6}) {
    const Design design = testing::make_random_design(seed, 0.02);
    const Superelement body = make_superelement(design);
    const Eigen::VectorXd expected = FreeBodyTruth(design.model).calc_frequencies();
    const double limit = kBandMargin * *design.reduction.highest_hz;
    const auto k = static_cast<int>((expected.array() < limit).count());
    REQUIRE(count_kind(body, kFreeVector) == k);
    CHECK(count_kind(body, kResidualVector) == body.num_modes() - k);
    for (int i = 0; i < k; ++i) {
      CHECK(body.kind_of(i) == kFreeVector);
      CHECK(body.frequency_hz(i) == Approx(expected(i)).epsilon(1e-9));
    }
    for (int i = k; i < body.num_modes(); ++i) CHECK(body.frequency_hz(i) >= expected(k) * (1.0 - 1e-9));
    CHECK(body.certificate->cutoff_hz == Approx(expected(k)).epsilon(1e-9));
    for (const CheckResult& check : body.checks) {
      INFO(check.name);
      CHECK(check.passed());
    }
  }
}

// Expected: the response of the full model to unit loads at the interface, without rigid motion.
TEST_CASE("with all residual vectors deflections at rest under interface loads are exact to 1e-9") {
  for (const std::uint64_t seed : {0, 1, 4, 6}) {
    Design design = testing::make_random_design(seed, 1.0);
    design.reduction.all_residual = true;
    const Superelement body = make_superelement(design);
    const Eigen::MatrixXd expected =
        FreeBodyTruth(design.model).calc_flexibility_at_rest(design.reduction.interface);
    const Eigen::MatrixXd found = testing::calc_flexibility(body, 0.0);
    for (Eigen::Index i = 0; i < found.rows(); ++i) {
      for (Eigen::Index j = 0; j < found.cols(); ++j) {
        CHECK(std::abs(found(i, j) - expected(i, j)) < 1e-9 * std::sqrt(expected(i, i) * expected(j, j)));
      }
    }
  }
}

TEST_CASE("a smaller tolerance takes more vectors, and reaches it") {
  int before = 0;
  for (const double tolerance : {0.3, 0.03, 1e-3, 1e-5}) {
    const Superelement body = make_superelement(testing::make_random_design(3, tolerance));
    CHECK(body.certificate->largest_error() <= tolerance);
    CHECK(body.num_modes() >= before);
    before = body.num_modes();
  }
}

// Expected: the full model's flexibility. A tolerance below the share that is chosen together ends one by
// one.
TEST_CASE("with many loads the tolerance is reached with at most a vector for each") {
  for (const double tolerance : {0.03, 1e-4}) {
    Design design = testing::make_random_design(3, tolerance);
    std::vector<int> nodes(22);
    std::iota(nodes.begin(), nodes.end(), 0);
    design.model.mesh.named_nodes.clear();
    design.reduction.interface = testing::make_interface(design.model, nodes);
    const auto b = static_cast<int>(design.reduction.interface.size());
    REQUIRE(b == 66);
    const Superelement body = make_superelement(design);
    CHECK(count_kind(body, kResidualVector) <= b);
    CHECK(body.certificate->largest_error() <= tolerance);
    const FreeBodyTruth truth(design.model);
    for (const double frequency : {0.0, 0.7, 1.0}) {
      const double s = std::pow(2.0 * std::numbers::pi * frequency * *design.reduction.highest_hz, 2);
      if (testing::is_resonance(truth, s)) continue;
      const Eigen::VectorXd missing =
          (truth.calc_flexibility(s, design.reduction.interface).real() - testing::calc_flexibility(body, s))
              .diagonal()
              .cwiseAbs();
      for (int j = 0; j < b; ++j) {
        const InterfaceError& one = body.certificate->interface[static_cast<std::size_t>(j)];
        CHECK(missing(j) <= (one.error + 1e-8) * one.static_flexibility);
      }
    }
  }
}

TEST_CASE("a basis does not depend on the order of nodes and elements, also of a symmetric body") {
  fem::BeamModel model = testing::make_spoked_square(0.0);
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(-0.5, -0.5)}) {
    testing::make_interface(model, {testing::find_node_at(model, corner)});
  }
  const auto make = [](const fem::BeamModel& frame) {
    Design design = testing::make_design(frame, {0.0, 0.0}, {});
    design.reduction = {.basis = BasisKind::kFree, .highest_hz = 300.0, .tolerance = 0.01, .interface = {}};
    for (int point = 0; point < 2; ++point) {
      for (int freedom = 0; freedom < 3; ++freedom) {
        design.reduction.interface.push_back(
            {point, frame.mesh.named_nodes[static_cast<std::size_t>(point)].node, freedom});
      }
    }
    return make_superelement(design);
  };
  const Superelement body = make(model), other = make(testing::renumber(model, 5));
  REQUIRE(body.num_modes() == other.num_modes());
  CHECK(testing::calc_difference(body, other) < 1e-7);
}

TEST_CASE("the reference can be an interface point, and two points can share a node") {
  Design design = testing::make_random_design(2, 0.01);
  design.reference_node = design.reduction.interface.front().node;
  const Superelement body = make_superelement(design);
  const double s = std::pow(2.0 * std::numbers::pi * *design.reduction.highest_hz, 2);
  const Eigen::VectorXd truth =
      FreeBodyTruth(design.model).calc_flexibility(s, design.reduction.interface).real().diagonal();
  const Eigen::VectorXd found = testing::calc_flexibility(body, s).diagonal();
  for (Eigen::Index j = 0; j < found.size(); ++j) {
    const InterfaceError& one = body.certificate->interface[static_cast<std::size_t>(j)];
    CHECK(std::abs(truth(j) - found(j)) <= (one.error + 1e-8) * one.static_flexibility);
  }
  // The same load twice: the second adds nothing.
  Design twice = testing::make_random_design(2, 0.01);
  const int num_modes = make_superelement(twice).num_modes();
  const std::size_t b = twice.reduction.interface.size();
  for (std::size_t j = 0; j < b; ++j) twice.reduction.interface.push_back(twice.reduction.interface[j]);
  CHECK(make_superelement(twice).num_modes() == num_modes);
  twice.reduction.all_residual = true;
  CHECK(make_superelement(twice).num_modes() <= num_modes + static_cast<int>(b));
}

TEST_CASE("a reduction tells what it is at") {
  std::vector<std::string> states;
  make_superelement(testing::make_random_design(2, 0.01),
                    {.progress = [&](const std::string& state) { states.push_back(state); }});
  REQUIRE(states.size() > 4);
  CHECK(states.front() == "factors of the stiffness");
  CHECK(states[1].starts_with("count of the modes below "));
  CHECK(std::find(states.begin(), states.end(), "residual vector 1") != states.end());
  CHECK(states.back() == "inertia, section loads and checks");
}

TEST_CASE("a body whose reference node is soft can be reduced") {
  const Design design = testing::make_softly_held_design();
  const Superelement body = make_superelement(design);
  CHECK(body.certificate->largest_error() <= 0.01);
  const Eigen::VectorXd truth =
      FreeBodyTruth(design.model).calc_flexibility_at_rest(design.reduction.interface).diagonal();
  const Eigen::VectorXd found = testing::calc_flexibility(body, 0.0).diagonal();
  CHECK(((truth - found).cwiseQuotient(truth)).cwiseAbs().maxCoeff() < 0.01);
}

// Five rigid bodies on stiff joints; the truth is the vehicle with the full model of the ladder.
TEST_CASE("the ladder frame with stiff joints at 1 %: at most 20 vectors, frequencies, reactions") {
  const testing::LadderFrame ladder = testing::make_ladder_frame();
  Design design = testing::make_design(ladder.model, ladder.reference, {});
  design.reduction = {
      .basis = BasisKind::kFree, .highest_hz = 70.0, .tolerance = 0.01, .interface = ladder.interface};
  const Superelement body = make_superelement(design);
  CHECK(body.num_modes() <= 20);
  const testing::CoupledVehicle truth = testing::make_ladder_vehicle(ladder);
  const testing::CoupledVehicle reduced = testing::make_ladder_vehicle(ladder, body);
  const testing::VehicleError error = testing::compare_vehicles(reduced, truth, 70.0);
  CHECK(error.frequency < 5e-4);
  CHECK(error.reaction < 0.01);
}

}  // namespace
}  // namespace sprung::reduce

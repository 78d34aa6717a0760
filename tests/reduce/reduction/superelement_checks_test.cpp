#include "reduce/reduction/superelement_checks.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "reduce/inspection/superelement_tables.h"
#include "reduce/program/commands.h"
#include "reduce/reduction/element_work.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/terminal/program.h"

namespace sprung::reduce {
namespace {

Superelement make_body(bool shear_and_rotary_inertia) {
  fem::BeamModel model = testing::make_model({testing::make_section(shear_and_rotary_inertia)});
  testing::add_line(model, {0.3, -0.2}, {1.5, 0.4}, 3);
  testing::add_line(model, {1.5, 0.4}, {1.1, 1.7}, 2);
  return make_superelement(testing::make_design(model, {0.3, -0.2}, {}));
}

// Names of the checks that fail after a change.
std::vector<std::string> find_failed(const Superelement& body,
                                     const std::function<void(Superelement&)>& change) {
  Superelement changed = body;
  change(changed);
  std::vector<std::string> names;
  for (const CheckResult& check : check_superelement(changed)) {
    if (!check.passed()) names.push_back(check.name);
  }
  return names;
}

TEST_CASE("a sound superelement passes every check with room to spare") {
  for (const bool rotary : {false, true}) {
    for (const CheckResult& check : check_superelement(make_body(rotary))) {
      CAPTURE(check.name, check.value, check.tolerance);
      CHECK(check.value <= 0.1 * check.tolerance);
    }
  }
}

// With another library for linear algebra the last digits differ.
TEST_CASE("rounding counts by the size of the inertia, which is large where the reference node is soft") {
  const Superelement body = make_superelement(testing::make_softly_held_design());
  REQUIRE(body.inertia.M_ff.diagonal().maxCoeff() > 1e4);
  CHECK(find_failed(body, [](Superelement& s) {
          s.inertia.B *= 1.0 + 1e-12;
          s.inertia.d *= 1.0 + 1e-12;
          s.inertia.phi_y_phi_y *= 1.0 + 1e-12;
        }).empty());
  CHECK(find_failed(body, [](Superelement& s) { s.inertia.B *= 1.0 + 1e-6; }).size() == 1);
}

TEST_CASE("each check fails on the fault that it is there for") {
  const Superelement body = make_body(true), with_point = testing::make_two_armed_body();
  using Names = std::vector<std::string>;
  CHECK(find_failed(body, [](Superelement& s) { s.mass(1, 1) += 1e-6; }) ==
        Names{"orthogonality of the modes"});
  CHECK(find_failed(body, [](Superelement& s) {
          s.frequency_hz(2) *= 1.0 + 1e-4;
          s.damping(2, 2) *= 1.0 + 1e-4;
        }) == Names{"stiffness against frequencies"});
  CHECK(find_failed(body, [](Superelement& s) {
          s.stiffness(1, 2) = s.stiffness(2, 1) = 1e-10 * s.stiffness(1, 1);
        }) == Names{"stiffness between clusters"});
  CHECK(find_failed(body, [](Superelement& s) { s.damping(3, 3) *= 1.001; }) ==
        Names{"damping against ratios"});
  CHECK(find_failed(body, [](Superelement& s) { s.inertia.d(2) += 1e-6; }) ==
        Names{"inertia against its components"});
  CHECK(find_failed(body, [](Superelement& s) { s.inertia.B *= 1.001; }) ==
        Names{"inertia against its components"});
  CHECK(find_failed(body, [](Superelement& s) { s.inertia.phi_x_phi_x(2, 2) += 1e-3; }) ==
        Names{"inertia against its components"});
  CHECK(find_failed(body, [](Superelement& s) {
          s.inertia.c(0) *= 1.2;
          s.inertia.x_phi_y(0) *= 1.01;
        }).size() >= 1);
  CHECK(find_failed(body, [](Superelement& s) { s.inertia.P *= 2.0; }) ==
        Names{"condition of the mass matrix of frame and modes"});
  CHECK(find_failed(body, [](Superelement& s) { s.shapes(1, 4) = 1e-6; }).front() ==
        "modes at the reference node");
  CHECK(find_failed(body, [](Superelement& s) {
          s.resultants(12, 0) *= 1.001;
          s.resultants(15, 0) *= 1.001;
        }) == Names{"work of the resultants against stiffness"});
  CHECK(find_failed(with_point, [](Superelement& s) { s.section_loads->point_load *= 1.01; }) ==
        Names{"work of the section loads on the modes"});
  const Names unbalanced = find_failed(body, [](Superelement& s) { s.resultants(13, 0) *= 1.01; });
  CHECK(std::count(unbalanced.begin(), unbalanced.end(), "equilibrium of the elements") == 1);
}

TEST_CASE("work of the resultants splits into axial and bending, and both make the stiffness") {
  const Superelement body = make_body(true);
  const ElementWork work = calc_element_work(body);
  CHECK((work.axial + work.bending - body.stiffness).cwiseAbs().maxCoeff() <
        1e-10 * body.stiffness.maxCoeff());
  // Straight bodies: the truck's pairs are bending, bending, axial.
  const Superelement chassis =
      make_superelement(read_design(testing::source_path("meshes/truck/chassis.toml")));
  const ModeKinds kinds = calc_mode_kinds(chassis);
  const double expected[] = {0.0, 0.0, 0.0, 0.0, 1.0, 1.0};
  for (int i = 0; i < 6; ++i) CHECK(kinds.axial_share(i) == Approx(expected[i]).margin(1e-9));
}

TEST_CASE("effective masses add up to the part of the body that the held node's elements do not keep") {
  // All modes and the held node's share: Σ p² = Rᵀ M R − what moves with the node only; never more than the
  // whole.
  const Superelement body = make_body(false);
  const ModeKinds kinds = calc_mode_kinds(body);
  CHECK((kinds.effective_mass.rowwise().sum().array() < 1.0).all());
  CHECK((kinds.effective_mass.rowwise().sum().array() > 0.8).all());
  // First bending mode of a uniform cantilever: 61.3 % (Blevins; 4 (0.7341/1.8751)² = 0.613).
  const Superelement star = make_superelement(
      testing::make_design(testing::make_star(2, 0.0, 10), {0.0, 0.0}, {.wanted = ModeCount{2}}));
  CHECK(calc_mode_kinds(star).effective_mass(1, 0) == Approx(0.6131).epsilon(1e-3));
}

// With all motions of the model the sum is a property of the body: M_e of the held frame (clamped modes) and
// that of the free vectors are the same, whatever vectors span them. With some, less than the whole.
TEST_CASE("effective masses of free and residual vectors add up to those of the clamped modes") {
  Design design = testing::make_random_design(3, 0.01);
  const Eigen::Vector3d part = calc_mode_kinds(make_superelement(design)).effective_mass.rowwise().sum();
  CHECK((part.array() < 1.0).all());
  design.reduction.highest_hz = 1e7;
  const Superelement free = make_superelement(design);
  REQUIRE(free.num_modes() == free.num_elastic_dofs);
  const Eigen::Vector3d found = calc_mode_kinds(free).effective_mass.rowwise().sum();
  design.reduction = {};
  design.modes = {.wanted = AllModes{}};
  const Eigen::Vector3d expected = calc_mode_kinds(make_superelement(design)).effective_mass.rowwise().sum();
  CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-8);
  CHECK((part.array() <= expected.array() + 1e-8).all());
}

TEST_CASE("the check command's exit code tells whether a check failed, recorded or made again") {
  Superelement body = make_body(false);
  write_superelement(body, "sound.h5");
  CHECK(run_check({"sound.h5"}, true) == support::kGood);
  Superelement recorded = body;
  recorded.checks[2].value = 1.0;  // the residual, which cannot be made again
  write_superelement(recorded, "recorded.h5");
  CHECK(run_check({"recorded.h5"}, true) == support::kCheckFailed);
  Superelement wrong = body;
  wrong.resultants *= 1.01;
  write_superelement(wrong, "wrong.h5");
  CHECK(run_check({"wrong.h5"}, true) == support::kCheckFailed);
  CHECK(run_check({"wrong.h5", "sound.h5"}, true) == support::kCheckFailed);
}

}  // namespace
}  // namespace sprung::reduce

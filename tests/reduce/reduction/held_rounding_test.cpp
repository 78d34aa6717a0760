#include "reduce/reduction/held_rounding.h"

#include <algorithm>

#include "reduce/reduction/reduction.h"
#include "reduce/reduction/superelement_checks.h"
#include "tests/catch.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {
namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

// A beam with a small part on its middle, which has so much of the beam's stiffness and mass per length. The
// reference is at the part's end, or where it stands.
Design make_body_on_soft_part(double stiffness, double mass, bool is_held_at_end) {
  fem::BeamModel model = testing::make_model({testing::make_section(), testing::make_section()});
  model.sections[1].bending_rigidity *= stiffness;
  model.sections[1].axial_rigidity *= stiffness;
  model.sections[1].mass_per_length *= mass;
  testing::add_line(model, {-1.0, 0.0}, {1.0, 0.0}, 8, 0);
  testing::add_line(model, {0.0, 0.0}, {0.0, 0.5}, 1, 1);
  const std::vector<InterfaceFreedom> interface = testing::make_interface(
      model, {testing::find_node_at(model, {-1.0, 0.0}), testing::find_node_at(model, {1.0, 0.0})}, {0, 1});
  model.mesh.named_nodes.push_back({.name = "foot", .node = testing::find_node_at(model, {0.0, 0.0})});
  model.mesh.named_nodes.push_back({.name = "tip", .node = testing::find_node_at(model, {0.0, 0.5})});
  Design design = testing::make_design(model, {0.0, is_held_at_end ? 0.5 : 0.0}, {});
  design.reduction = {.basis = BasisKind::kFree, .highest_hz = 100.0, .interface = interface};
  return design;
}

double find_check(const Superelement& body, const char* name) {
  const auto found = std::find_if(body.checks.begin(), body.checks.end(),
                                  [&](const CheckResult& check) { return check.name == name; });
  return found == body.checks.end() ? -1.0 : found->value;
}

// A free body does not depend on where it is held: the expected numbers are those of the body that is held
// where the soft part stands. Its points there do not move at all against the end of a part without mass.
TEST_CASE("a body whose reference node is soft and has no mass is reduced rightly") {
  for (const double stiffness : {1e-8, 1e-6, 1e-3, 1.0}) {
    for (const BasisKind basis : {BasisKind::kFree, BasisKind::kFixedInterface}) {
      Design design = make_body_on_soft_part(stiffness, 0.0, true);
      design.reduction.basis = basis;
      const Superelement body = make_superelement(design);
      design.reference_node = testing::find_node_at(design.model, {0.0, 0.0});
      const Superelement expected = make_superelement(design);
      INFO("stiffness " << stiffness);
      REQUIRE(body.num_modes() == expected.num_modes());
      CHECK((body.frequency_hz.cwiseQuotient(expected.frequency_hz).array() - 1.0).abs().maxCoeff() < 1e-8);
      for (std::size_t j = 0; j < body.certificate->interface.size(); ++j) {
        const InterfaceError &one = body.certificate->interface[j],
                             &other = expected.certificate->interface[j];
        CHECK_THAT(one.static_flexibility, WithinRel(other.static_flexibility, 1e-8));
        CHECK_THAT(one.static_error, WithinAbs(other.static_error, 1e-8));
        CHECK_THAT(one.error, WithinAbs(other.error, 1e-8) || WithinRel(other.error, 1e-8));
      }
    }
  }
}

// The soft part has 3e-8 of the beam's stiffness and hardly mass, as a wire: it is a mode of its own.
TEST_CASE("a body that is held at the end of a wire is reduced") {
  const Superelement body = make_superelement(make_body_on_soft_part(3e-8, 1e-4, true));
  const Superelement expected = make_superelement(make_body_on_soft_part(3e-8, 1e-4, false));
  const double rounding = find_check(body, kHeldRoundingCheck);
  CHECK(rounding > 1e-6);
  CHECK(rounding < 1e-3);
  CHECK(find_check(body, kResidualCheck) > 1e-6);  // rounding, which a check of 1e-6 takes for a fault
  CHECK((body.frequency_hz.cwiseQuotient(expected.frequency_hz).array() - 1.0).abs().maxCoeff() < 1e-4);
}

TEST_CASE("a reference node that is too soft is named, and another one beside it") {
  for (const BasisKind basis : {BasisKind::kFree, BasisKind::kFixedInterface, BasisKind::kClamped}) {
    for (const double stiffness : {1e-12, 1e-18}) {  // the second one leaves no factors of the stiffness
      Design design = make_body_on_soft_part(stiffness, 0.0, true);
      design.reduction.basis = basis;
      design.modes = {.wanted = ModeCount{4}};
      CHECK_THAT(testing::message_of<support::NumericalError>([&] { make_superelement(design); }),
                 Contains("the reference, node") && Contains("'tip'") && Contains("softly") &&
                     Contains("such as 'foot'"));
    }
  }
}

// uᵀM u of a cantilever under its own inertia: its best straight line leaves 3 %.
TEST_CASE("a body that bends is not taken for one on a soft reference node") {
  const Design design = make_body_on_soft_part(1.0, 1.0, false);
  const HeldRounding held = estimate_held_rounding(make_body_matrices(design));
  CHECK(held.bent_share > 0.01);
  CHECK(held.error < 1e-10);
  CHECK_FALSE(held.is_of_soft_reference());
}

}  // namespace
}  // namespace sprung::reduce

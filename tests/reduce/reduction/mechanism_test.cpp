#include "reduce/reduction/mechanism.h"

#include <cmath>

#include "reduce/modes/clamped_modes.h"
#include "reduce/modes/rounding_error.h"
#include "reduce/reduction/body_basis.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {
namespace {

// Two stiff beams joined by an element that hardly bends back.
Design make_hinged(double bending) {
  fem::BeamModel model = testing::make_model({testing::make_section(), testing::make_section()});
  model.sections[1].bending_rigidity *= bending;
  testing::add_line(model, {0.0, 0.0}, {1.0, 0.0}, 4, 0);
  testing::add_line(model, {1.0, 0.0}, {1.05, 0.0}, 1, 1);
  testing::add_line(model, {1.05, 0.0}, {2.0, 0.3}, 4, 0);
  const auto interface = testing::make_interface(model, {testing::find_node_at(model, {2.0, 0.3})});
  Design design = testing::make_design(model, {0.0, 0.0}, {});
  design.reduction = {.basis = BasisKind::kFree, .highest_hz = 50.0, .interface = interface};
  return design;
}

TEST_CASE("an element that gives way without force is named as an internal mechanism") {
  const std::string message =
      testing::message_of<support::NumericalError>([] { make_superelement(make_hinged(1e-13)); });
  CHECK_THAT(message, Contains("internal mechanism"));
}

// The right half slides across the hinge and turns about it, so that what moves most moves along y. With the
// first bending the held frame still has factors, but its modes have none.
TEST_CASE("of a hinge without stiffness the message names what moves, and the element that gives way") {
  for (const double bending : {1e-16, 1e-20}) {
    const std::string message =
        testing::message_of<support::NumericalError>([&] { make_superelement(make_hinged(bending)); });
    CHECK_THAT(message, Contains("internal mechanism") && Contains("moves most at node") &&
                            Contains(" along y") && Contains("gives way without force in the element") &&
                            Contains("at (1, 0)") && Contains("at (1.05, 0)"));
  }
}

TEST_CASE("a mode that rounding spoils is refused where the lowest one is sound") {
  fem::BeamModel model = testing::make_model({testing::make_section(), testing::make_section()});
  model.sections[1].bending_rigidity *= 0.01;
  testing::add_line(model, {0.0, 0.0}, {10.0, 0.0}, 10, 0);
  testing::add_line(model, {5.0, 0.0}, {5.0, 1.0}, 2000, 1);
  const auto interface = testing::make_interface(model, {testing::find_node_at(model, {10.0, 0.0})});
  Design design = testing::make_design(model, {0.0, 0.0}, {});
  design.reduction = {.basis = BasisKind::kFree, .highest_hz = 10.0, .interface = interface};
  const auto message = [&] {
    return testing::message_of<support::NumericalError>([&] { make_superelement(design); });
  };
  CHECK_THAT(message(), Contains("rounding spoils mode 2") && Contains("where this mode bends"));
  design.reduction.highest_hz = 3.0;  // without the short beam's modes
  CHECK(make_superelement(design).kind.front() == kFreeVector);
}

// Exact: ω² = (1.8751/L)⁴ EI/m of a uniform cantilever, which so many elements meet to 1e-10.
TEST_CASE("a finely meshed body is judged by the error that rounding really makes") {
  constexpr double kLength = 3.0;
  const fem::BeamProperties section = testing::make_section();
  const double exact =
      std::pow(1.8751040687119611 / kLength, 4) * section.bending_rigidity / section.mass_per_length;
  int num_accepted = 0, num_refused = 0;  // of those whose estimate exceeds the limit
  for (const int num_elements : {1000, 1100, 1200, 1300, 1400, 1500, 1750, 2000, 2500, 3000}) {
    fem::BeamModel model = testing::make_model();
    testing::add_line(model, {0.0, 0.0}, {kLength, 0.0}, num_elements);
    const Design design = testing::make_design(model, {0.0, 0.0}, {});
    const BodyMatrices matrices = make_body_matrices(design);
    const Eigen::SparseMatrix<double>& stiffness = matrices.free.stiffness;
    const ClampedModes modes = calc_clamped_modes(matrices.make_held(), 1);
    const EigenPairs lowest{.omega_squared = modes.pairs.omega_squared.head(1),
                            .vectors = modes.pairs.vectors.leftCols(1)};
    const double error = std::abs(lowest.omega_squared(0) / exact - 1.0);
    if (estimate_rounding_error(stiffness, lowest.vectors.col(0), lowest.omega_squared(0)) <=
        kMaxRoundingError)
      continue;
    CAPTURE(num_elements, error);
    if (error > kMaxRoundingError) {
      CHECK_THROWS_AS(check_rounding(design, stiffness, lowest), support::NumericalError);
      ++num_refused;
    } else {
      CHECK(check_rounding(design, stiffness, lowest) == Approx(error).epsilon(0.02));
      ++num_accepted;
    }
  }
  CHECK(num_accepted >= 2);
  CHECK(num_refused >= 2);
}

TEST_CASE("a body that is soft at one place, but not to rounding, is reduced") {
  const Superelement body = make_superelement(make_hinged(1e-4));
  CHECK(body.kind.front() == kFreeVector);
  CHECK(body.certificate->largest_error() <= body.certificate->tolerance);
}

}  // namespace
}  // namespace sprung::reduce

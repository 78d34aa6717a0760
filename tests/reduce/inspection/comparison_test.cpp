#include "reduce/inspection/comparison.h"

#include <algorithm>
#include <cmath>

#include "reduce/inspection/superelement_tables.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

const WantedModes kSix{.wanted = ModeCount{6}};

Superelement reduce_star(int num_elements, double angle = 0.3, const WantedModes& request = kSix) {
  return make_superelement(
      testing::make_design(testing::make_star(2, angle, num_elements), {0.0, 0.0}, request));
}

TEST_CASE("a body compared with itself has a MAC of one and no change") {
  const Superelement body = reduce_star(5);
  const Comparison comparison = compare_modes(body, body);
  REQUIRE(comparison.matches.size() == 3);
  CHECK(comparison.comparable);
  for (const ModeMatch& match : comparison.matches) {
    CHECK(match.mac == Approx(1.0).epsilon(1e-12));
    CHECK(match.old_hz == match.new_hz);
    CHECK(match.old_modes.begin == match.new_modes.begin);
    CHECK(match.old_modes.size() == 2);
  }
}

TEST_CASE("a refined mesh has the same modes") {
  const Comparison comparison = compare_modes(reduce_star(4), reduce_star(7));
  REQUIRE(comparison.comparable);
  REQUIRE(comparison.matches.size() == 3);
  CHECK(comparison.matches[0].mac > 0.9999);
  CHECK(comparison.matches[1].mac > 0.999);
  CHECK(comparison.matches[0].new_hz < comparison.matches[0].old_hz);  // from above, as Ritz values do
}

TEST_CASE("clusters are compared by subspace, not member by member") {
  const Superelement body = reduce_star(5);
  Superelement rotated = body;
  const double angle = 0.7;
  rotated.shapes.col(0) = std::cos(angle) * body.shapes.col(0) + std::sin(angle) * body.shapes.col(1);
  rotated.shapes.col(1) = std::cos(angle) * body.shapes.col(1) - std::sin(angle) * body.shapes.col(0);
  CHECK(compare_modes(body, rotated).matches[0].mac == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("a pair that a design change splits is matched with both of its members") {
  const Superelement pair = reduce_star(5);
  fem::BeamModel model = testing::make_star(2, 0.3, 5);
  model.point_masses = {{.node = 5, .mass = 0.05, .inertia = 0.0}};
  const Superelement split = make_superelement(testing::make_design(model, {0.0, 0.0}, kSix));
  REQUIRE(split.cluster(1) != split.cluster(0));
  const Comparison comparison = compare_modes(pair, split);
  REQUIRE(comparison.matches.size() >= 2);
  for (int i = 0; i < 2; ++i) {
    const ModeMatch& match = comparison.matches[static_cast<std::size_t>(i)];
    CHECK(match.old_modes.size() == 2);
    CHECK(match.old_modes.begin == 0);
    CHECK(match.new_modes.begin == i);
    CHECK(match.new_modes.size() == 1);
    CHECK(match.mac > 0.999);
  }
  const Comparison back = compare_modes(split, pair);
  CHECK(back.matches[0].new_modes.size() == 2);
  CHECK(back.matches[1].new_modes.size() == 2);
}

TEST_CASE("modes that change places are matched by shape") {
  // A much larger area brings the axial pair (modes 5 and 6) above the third bending pair.
  const auto reduce = [](double area_factor) {
    fem::BeamModel model = testing::make_star(2, 0.0, 8);
    model.sections[0].axial_rigidity *= area_factor;
    return make_superelement(testing::make_design(model, {0.0, 0.0}, {.wanted = ModeCount{12}}));
  };
  const Superelement soft = reduce(0.05), stiff = reduce(1.0);
  const Comparison comparison = compare_modes(soft, stiff);
  bool changed_places = false;
  for (const ModeMatch& match : comparison.matches) {
    if (match.old_modes.size() == 0 || match.new_modes.size() == 0) continue;
    CHECK(match.mac > 0.9);
    changed_places = changed_places || match.old_modes.begin != match.new_modes.begin;
  }
  CHECK(changed_places);
}

TEST_CASE("modes without a counterpart are listed alone") {
  const Comparison comparison = compare_modes(reduce_star(5, 0.3, {.wanted = ModeCount{4}}), reduce_star(5));
  REQUIRE(comparison.matches.size() == 3);
  CHECK(comparison.matches[2].old_modes.size() == 0);
  CHECK(comparison.matches[2].new_modes.begin == 4);
  CHECK(std::isnan(comparison.matches[2].mac));
}

TEST_CASE("bodies without nodes at common positions are compared by frequency only, and the table says so") {
  const Comparison comparison = compare_modes(reduce_star(5, 0.3), reduce_star(5, 1.1));
  CHECK_FALSE(comparison.comparable);
  REQUIRE(comparison.matches.size() == 3);
  CHECK(std::isnan(comparison.matches[0].mac));
  CHECK_THAT(format_comparison(comparison), Contains("too few places in common for a MAC: ") &&
                                                Contains("% must; modes are paired by their order"));
}

// Expected: free modes of one frame are mass-orthogonal, whatever the reference, and the same for any
// reference.
TEST_CASE("free modes are compared about the mean axes") {
  const auto reduce = [](int reference_node) {
    Design design = testing::make_random_design(1, 0.01);
    design.reference_node = reference_node;
    design.reduction.highest_hz = 3.0 * make_superelement(design).certificate->cutoff_hz;
    return make_superelement(design);
  };
  const Superelement at_first = reduce(0), at_last = reduce(at_first.num_nodes() - 1);
  REQUIRE(at_first.node_positions.col(0).norm() == 0.0);
  REQUIRE(at_last.node_positions.col(0).norm() > 0.0);
  for (const Comparison& comparison : {compare_modes(at_first, at_last), compare_modes(at_last, at_last)}) {
    REQUIRE(comparison.comparable);
    REQUIRE(comparison.matches.size() > 3);
    for (const ModeMatch& match : comparison.matches) {
      CHECK(match.old_modes.begin == match.new_modes.begin);
      CHECK(match.mac == Approx(1.0).epsilon(1e-6));
      CHECK(match.old_hz == Approx(match.new_hz).epsilon(1e-9));
    }
  }
}

TEST_CASE("free modes are not compared with clamped ones") {
  const Superelement held = reduce_star(5);
  Superelement free = held;
  free.kind.assign(6, kFreeVector);
  const Comparison comparison = compare_modes(held, free);
  CHECK_FALSE(comparison.are_alike);
  CHECK_FALSE(comparison.comparable);
  CHECK(std::isnan(comparison.matches[0].mac));
  CHECK_THAT(format_comparison(comparison), Contains("have no MAC"));
}

// A wider band adds free modes, and other residual vectors: the modes of the first band stay as they are.
TEST_CASE("residual vectors are counted, and not compared as if they were modes") {
  const auto reduce = [](double highest_hz) {
    Design design = testing::make_random_design(0, 0.01);
    design.reduction.highest_hz = highest_hz;
    return make_superelement(design);
  };
  const double first_hz = reduce(1.0).certificate->cutoff_hz;
  const Superelement narrow = reduce(1.0 * first_hz), wide = reduce(3.0 * first_hz);
  const auto count = [](const Superelement& body) {
    return static_cast<Eigen::Index>(std::count(body.kind.begin(), body.kind.end(), kFreeVector));
  };
  REQUIRE(count(wide) > count(narrow));
  REQUIRE(count(narrow) < narrow.num_modes());
  const Comparison comparison = compare_modes(narrow, wide);
  CHECK(comparison.num_other_old == narrow.num_modes() - count(narrow));
  CHECK(comparison.num_other_new == wide.num_modes() - count(wide));
  Eigen::Index num_new = 0;
  for (const ModeMatch& match : comparison.matches) {
    num_new += match.new_modes.size();
    if (match.old_modes.size() == 0) continue;
    CHECK(match.new_hz == Approx(match.old_hz).epsilon(1e-9));
    CHECK(match.new_modes.begin == match.old_modes.begin);
  }
  CHECK(num_new == count(wide));
  CHECK_THAT(format_comparison(comparison), Contains("Not compared: ") && Contains("no modes of it"));
}

TEST_CASE("the MAC of two single modes is that of the formula") {
  const Superelement body = reduce_star(5, 0.3, {.wanted = ModeNumbers{{1}}});
  Superelement other = body;
  const Superelement all = reduce_star(5);
  other.shapes.col(0) = all.shapes.col(0) + 0.5 * all.shapes.col(2);
  // Weighted with the length of each node, uniform here but for the halved ends.
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (Eigen::Index node = 0; node < body.num_nodes(); ++node) {
    const double distance = body.node_positions.col(node).norm();
    const double weight = distance > 1.199 ? 0.5 : 1.0;
    const Eigen::Vector2d a = body.shapes.col(0).segment<2>(3 * node),
                          b = other.shapes.col(0).segment<2>(3 * node);
    ab += weight * a.dot(b);
    aa += weight * a.dot(a);
    bb += weight * b.dot(b);
  }
  CHECK(compare_modes(body, other).matches[0].mac == Approx(ab * ab / (aa * bb)).epsilon(1e-10));
}

TEST_CASE("the comparison table shows frequencies, change and MAC") {
  Superelement stiffer = reduce_star(5);
  stiffer.frequency_hz *= 1.02;
  const std::string table = format_comparison(compare_modes(reduce_star(5), stiffer));
  CHECK_THAT(table, Contains("1–2") && Contains("+2.000") && Contains("1.0000"));
}

}  // namespace
}  // namespace sprung::reduce

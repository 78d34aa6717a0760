// Modes that join and leave on small models with a known motion of each mode: beams held at their root, whose
// modes are not coupled in small motion.
#include "dynamics/simulation/adaptive_stepper.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/linear/cantilevers.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using namespace sprung::test::cantilevers;
using dynamics::Model;
using dynamics::TimeFunction;

namespace {

// It vibrates in its first mode from the start; a late force excites the second one.
Model make_late(double amplitude, std::vector<int>& nodes) {
  Model model;
  nodes = add_cantilever(model, "beam", {0.3, -0.2});
  push(model, nodes[5], burst(frequency(1), 1.0, 0.01, 1.0));
  push(model, nodes[2], burst(frequency(2), amplitude, 1.2, 1.8));
  dynamics::number_model(model);
  return model;
}

}  // namespace

TEST_CASE("A mode that is excited only late joins then, by its resonance, and in time", "[adaptivity]") {
  std::vector<int> nodes;
  const Model model = make_late(6.0, nodes);
  const Run full = drive(model, {.watched = nodes[5], .active = kAll});
  const Run adaptive = drive(model, {.watched = nodes[5], .active = {0}});
  // The first push may make it join for a while; when the burst begins it is not active.
  long before = 0;
  std::vector<double> joinings;
  for (const Change& change : adaptive.changes) {
    if (change.mode != "beam.mode 2") continue;
    if (change.time < 1.2) before += change.joins ? 1 : -1;
    if (change.time >= 1.2 && change.joins) joinings.push_back(change.time);
  }
  CHECK(before == 0);
  REQUIRE(joinings.size() == 1);
  CHECK(joinings[0] < 1.4);
  // Mode 2 contributes more to the tip's acceleration than mode 1; the force alone, without resonance, would
  // cause a fiftieth of that, 1/(2ζ).
  const Run one = drive(model, {.watched = nodes[5], .active = {0}, .changes = false});
  CHECK(largest_difference(one.tip_acceleration, full.tip_acceleration) >
        0.4 * largest(full.tip_acceleration));
  CHECK(largest_difference(adaptive.tip_acceleration, full.tip_acceleration) <
        kRecall * largest(full.tip_acceleration));
  CHECK(largest_difference(adaptive.tip, full.tip) < kRecall * largest(full.tip));
  CHECK(one.statistics.worst_neglect.acceleration.share > 0.3);
}

TEST_CASE("A mode whose share stays near the threshold joins at most once, and no larger share is left out",
          "[adaptivity]") {
  // The second mode is excited in each run by a force closer to the one at which it just joins.
  double below = 1e-3, above = 6.0;
  for (int i = 0; i < 12; ++i) {
    const double amplitude = i == 0 ? below : i == 1 ? above : std::sqrt(below * above);
    INFO("force " << amplitude << " N");
    Model model;
    const std::vector<int> nodes = add_cantilever(model, "beam", {0.3, -0.2});
    push(model, nodes[5], burst(frequency(1), 1.0, 0.01, 1.0));
    for (int k = 0; k < 4; ++k)
      push(model, nodes[2], burst(frequency(2), amplitude, 1.2 + 0.8 * k, 1.8 + 0.8 * k));
    dynamics::number_model(model);
    const Run run = drive(model, {.watched = nodes[5], .active = {0}, .duration = 4.5});
    long joinings = 0, leavings = 0;
    for (const Change& change : run.changes) {
      if (change.mode == "beam.mode 2" && change.time > 1.2) ++(change.joins ? joinings : leavings);
    }
    CHECK(joinings <= 1);
    CHECK(leavings <= joinings);
    if (i == 0) CHECK(joinings == 0);
    if (i == 1) CHECK(joinings == 1);
    (joinings > 0 ? above : below) = amplitude;
    const Run full = drive(model, {.watched = nodes[5], .active = kAll, .duration = 4.5});
    CHECK(largest_difference(run.tip_acceleration, full.tip_acceleration) <
          1.2 * kRecall * largest(full.tip_acceleration));
  }
  CHECK(above < 1.02 * below);
}

TEST_CASE("A mode whose share stays near the drop threshold leaves at most once and does not come back",
          "[adaptivity]") {
  double stays = 6.0, leaves = 1e-3;
  for (int i = 0; i < 14; ++i) {
    const double amplitude = i == 0 ? stays : i == 1 ? leaves : std::sqrt(stays * leaves);
    INFO("force " << amplitude << " N");
    Model model;
    const std::vector<int> nodes = add_cantilever(model, "beam", {0.3, -0.2});
    push(model, nodes[5], burst(frequency(1), 1.0, 0.01, 1.0));
    push(model, nodes[2], burst(frequency(2), amplitude, 0.01, 0.6));
    for (int k = 0; k < 4; ++k)
      push(model, nodes[2], burst(frequency(2), amplitude, 0.7 + 0.3 * k, 1.2 + 0.3 * k));
    dynamics::number_model(model);
    const Run run = drive(model, {.watched = nodes[5], .active = {0, 1}, .duration = 2.0});
    CHECK(run.count("beam.mode 2", true) == 0);
    CHECK(run.count("beam.mode 2", false) <= 1);
    if (i == 0) CHECK(run.count("beam.mode 2", false) == 0);
    if (i == 1) CHECK(run.count("beam.mode 2", false) == 1);
    (run.count("beam.mode 2", false) > 0 ? leaves : stays) = amplitude;
  }
}

TEST_CASE("A load at a mode's node makes its neighbours join and not the mode", "[adaptivity]") {
  // Right there: a point rigidly offset from a node by o along the beam moves by φ_y + o ψ in a mode, ψ its
  // rotation.
  const reduce::Superelement superelement = make_cantilever().superelement;
  Model model;
  const std::vector<int> nodes = add_cantilever(model, "beam", {0.3, -0.2});
  const dynamics::Marker& near = model.markers[static_cast<std::size_t>(nodes[4])];
  const double offset = -near.Phi(1, 1) / near.Phi(2, 1);
  const int at_node = test::add_node_marker(model, 0, superelement, 4, {offset, 0.0});
  REQUIRE(std::abs(model.markers[static_cast<std::size_t>(at_node)].Phi(1, 1)) < 1e-12);
  // With the frequencies of modes 2 and 3: by those alone mode 2 would be the first.
  push(model, at_node, burst(frequency(2), 50.0, 0.1, 0.6));
  push(model, at_node, burst(frequency(3), 50.0, 0.1, 0.6));
  dynamics::number_model(model);
  const Run run = drive(model, {.watched = nodes[5], .active = {}, .duration = 1.0});
  CHECK(run.count("beam.mode 1", true) >= 1);
  CHECK(run.count("beam.mode 3", true) >= 1);
  CHECK(run.count("beam.mode 2", true) == 0);
  const Run full = drive(model, {.watched = nodes[5], .active = kAll, .duration = 1.0});
  CHECK(largest_difference(run.tip_acceleration, full.tip_acceleration) <
        kRecall * largest(full.tip_acceleration));
}

TEST_CASE("After a sudden load modes join as if they had been active before", "[adaptivity]") {
  Model model;
  const std::vector<int> nodes = add_cantilever(model, "beam", {0.3, 0.0});
  push(model, nodes[5], TimeFunction(1.0));
  dynamics::number_model(model);
  const Run full = drive(model, {.watched = nodes[5], .active = kAll, .duration = 0.3});
  const Run adaptive = drive(model, {.watched = nodes[5], .active = {}, .duration = 0.3});
  CHECK(adaptive.num_active.front() > 0);  // they are there from the first output on
  // From rest it swings to nearly twice the deflection under the load, F L³/3EI.
  const dynamics::Body& beam = model.bodies[0];
  double still = 0.0;
  for (int k = 0; k < kNumModes; ++k) {
    still += std::pow(model.markers[static_cast<std::size_t>(nodes[5])].Phi(1, k), 2) / beam.stiffness(k, k);
  }
  CHECK(largest(full.tip) > 1.8 * still);
  CHECK(largest_difference(adaptive.tip, full.tip) < 0.02 * largest(full.tip));
}

TEST_CASE("Modes that an impact excites join with their vibration", "[adaptivity]") {
  // The tip swings onto a damper, whose force is there at once.
  const dynamics::FlatRoad ground;
  Model model;
  const std::vector<int> nodes = add_cantilever(model, "beam", {0.3, 0.301});
  push(model, nodes[5], burst(frequency(1), 1.0, 0.01, 1.0));
  model.forces.push_back(std::make_unique<dynamics::PointContactTyre>(
      "stop",
      dynamics::PointContactTyre::Parameters{.marker = nodes[5],
                                             .radius = 0.3,
                                             .spring = dynamics::PiecewisePolynomial({0.0, 1.0}),
                                             .damping = 20.0},
      dynamics::PlacedRoad{&ground, 1.0, 0.0}));
  dynamics::number_model(model);
  const Run full = drive(model, {.watched = nodes[5], .active = kAll, .duration = 1.2});
  const Run adaptive = drive(model, {.watched = nodes[5], .active = {0}, .duration = 1.2});
  const Run one = drive(model, {.watched = nodes[5], .active = {0}, .changes = false, .duration = 1.2});
  const double size = largest(full.tip_acceleration);
  CHECK(adaptive.count("beam.mode 2", true) >= 1);
  CHECK(largest_difference(one.tip_acceleration, full.tip_acceleration) > 0.4 * size);
  CHECK(largest_difference(adaptive.tip_acceleration, full.tip_acceleration) < 0.02 * size);
}

TEST_CASE("Of two equal bodies only the modes of the excited one join, in either order of the bodies",
          "[adaptivity]") {
  for (const bool loaded_first : {true, false}) {
    Model model;
    std::vector<int> loaded, idle;
    if (loaded_first) loaded = add_cantilever(model, "loaded", {0.0, 0.0});
    idle = add_cantilever(model, "idle", {0.0, 2.0});
    if (!loaded_first) loaded = add_cantilever(model, "loaded", {0.0, 0.0});
    push(model, loaded[5], burst(frequency(2), 50.0, 0.1, 0.6));
    dynamics::number_model(model);
    const Run run = drive(model, {.watched = loaded[5], .active = {}, .duration = 1.0});
    CHECK(run.count("loaded.mode 2", true) == 1);
    for (const Change& change : run.changes) CHECK_FALSE(change.mode.starts_with("idle"));
  }
}

TEST_CASE("The energy that leaving modes take with them is reported and booked", "[adaptivity]") {
  // Two beams that ring down a little out of step, so that one is at rest where the other is not, and leave
  // together at a threshold so high that what is lost can be seen.
  Model model;
  const std::vector<int> nodes = add_cantilever(model, "first", {0.0, 0.0});
  const std::vector<int> others = add_cantilever(model, "second", {0.0, 2.0});
  push(model, nodes[5], burst(frequency(1), 50.0, 0.01, 0.8));
  push(model, others[5], burst(frequency(1), 49.0, 0.02, 0.81));
  dynamics::number_model(model);
  const Run run = drive(model, {.watched = nodes[5],
                                .active = kAll,
                                .duration = 1.0,
                                .recall = 0.9,
                                .drop = 0.08,
                                .tolerance = 1e-9,
                                .may_leave = true});
  double lost = 0.0, time = -1.0;
  for (const Change& change : run.changes) {
    if (change.joins || change.time == time) continue;  // one number for all that leave together
    const std::size_t place = change.text.find("energy lost by all that leave ");
    REQUIRE(place != std::string::npos);
    lost += std::stod(change.text.substr(place + 30));
    time = change.time;
  }
  double open = 0.0;
  for (const dynamics::EnergyBook& book : run.energy) {
    const dynamics::EnergyBook& first = run.energy.front();
    open =
        std::max(open, std::abs(book.stored.total() - first.stored.total() + book.dissipated - book.input));
  }
  CHECK(lost > 1e-6);  // J
  CHECK(open < 0.01 * lost);
}

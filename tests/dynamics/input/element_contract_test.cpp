// What the solver takes for granted of every force element, for those of the examples in
// dynamics/models/README.md, which hold every kind.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dynamics/input/make_model.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/system/system_terms.h"
#include "tests/catch.h"
#include "tests/dynamics/forces/force_motion.h"
#include "tests/dynamics/input/input_cases.h"
#include "tests/dynamics/input/reference.h"
#include "tests/dynamics/random_numbers.h"
#include "tools/support/toml/toml.h"

using namespace sprung;

namespace {

using dynamics::ForceElement;
using test::MarkerPair;

constexpr int kMotions = 20;  // random ones of each element

struct Elements {
  dynamics::FlatRoad road;
  dynamics::Model model;
  std::vector<dynamics::MarkerState> markers;  // as drawn, at rest

  Elements() {
    test::write_history();
    const auto file = support::TomlDocument::parse(test::read_reference().vehicle, "vehicle example");
    const dynamics::Vehicle vehicle = dynamics::read_vehicle(file, test::superelement_folder());
    model = dynamics::make_model(vehicle, {}, {.road = &road});
    dynamics::SystemTerms terms(model);
    terms.update_positions(0.0, dynamics::make_start_positions(model, vehicle));
    terms.update_velocities(Eigen::VectorXd::Zero(model.num_coordinates));
    markers.assign(terms.markers().begin(), terms.markers().end());
  }

  // All markers near their drawing, the states of one element of their natural sizes, all in motion.
  MarkerPair move(const ForceElement& force, test::RandomNumbers& random) const {
    MarkerPair moved{.markers = markers};
    for (dynamics::MarkerState& marker : moved.markers) {
      marker.r += random.vector(2, 0.02);
      marker.v = random.vector(2, 1.0);
      marker.angle += random.size_up_to(0.05);
      marker.omega = random.size_up_to(1.0);
    }
    for (const dynamics::InternalState& state : force.internal_states())
      moved.states.push_back(random.size_up_to(state.size));
    return moved;
  }
};

std::vector<int> choose_branches(const ForceElement& force, const MarkerPair& pair) {
  std::vector<int> branches(static_cast<std::size_t>(force.num_branches()), 0);
  force.choose_branches(pair.instant(), branches);
  return branches;
}

std::vector<double> calc_rates(const ForceElement& force, const MarkerPair& pair) {
  std::vector<double> rates(pair.states.size(), std::numeric_limits<double>::quiet_NaN());
  force.calc_state_rates(pair.instant(), choose_branches(force, pair), rates);
  return rates;
}

}  // namespace

TEST_CASE("The energy of every element changes by what passes through it alone") {
  const Elements elements;
  test::RandomNumbers random(1);
  for (const auto& force : elements.model.forces) {
    CAPTURE(force->name, force->kind());
    double worst = 0.0;
    for (int i = 0; i < kMotions; ++i) {
      const MarkerPair pair = elements.move(*force, random);
      worst = std::max(worst, std::abs(test::calc_energy_leak(*force, pair, choose_branches(*force, pair))));
    }
    CHECK(worst < 1e-7);
  }
}

TEST_CASE("The internal states of every element rest where all is at rest, and follow motion") {
  const Elements elements;
  test::RandomNumbers random(2);
  int num_states = 0;
  for (const auto& force : elements.model.forces) {
    CAPTURE(force->name, force->kind());
    MarkerPair at_rest{.markers = elements.markers};
    at_rest.states.assign(force->internal_states().size(), 0.0);
    // A levelling valve fills or empties its spring until the vehicle has its height.
    const bool has_valve = std::ranges::any_of(force->channels(), [](const dynamics::Channel& channel) {
      return channel.role == dynamics::ChannelRole::kMassFlow;
    });
    if (!has_valve)
      for (const double rate : calc_rates(*force, at_rest)) CHECK(rate == 0.0);
    std::vector<double> largest(at_rest.states.size(), 0.0);
    for (int i = 0; i < kMotions; ++i) {
      const std::vector<double> rates = calc_rates(*force, elements.move(*force, random));
      for (std::size_t k = 0; k < rates.size(); ++k) {
        CHECK(std::isfinite(rates[k]));
        largest[k] = std::max(largest[k], std::abs(rates[k]));
      }
    }
    for (const double one : largest) CHECK(one > 0.0);
    num_states += static_cast<int>(largest.size());
  }
  CHECK(num_states > 4);
}

TEST_CASE("Every element gives all of its channels, each under a name of its own") {
  const Elements elements;
  test::RandomNumbers random(3);
  for (const auto& force : elements.model.forces) {
    CAPTURE(force->name, force->kind());
    const MarkerPair pair = elements.move(*force, random);
    std::vector<double> values(force->channels().size(), std::numeric_limits<double>::quiet_NaN());
    force->calc_channels(pair.instant(), choose_branches(*force, pair), values);
    test::Keys names;
    for (std::size_t c = 0; c < values.size(); ++c) {
      CAPTURE(force->channels()[c].name);
      CHECK(std::isfinite(values[c]));
      CHECK(names.emplace(force->channels()[c].name).second);
      CHECK(!dynamics::role_name(force->channels()[c].role).empty());
    }
  }
}

TEST_CASE("The laws in the place of those of an element have the number of its states and rates") {
  const Elements elements;
  int num_linearised = 0, num_dampers = 0;
  for (const auto& force : elements.model.forces) {
    CAPTURE(force->name, force->kind());
    MarkerPair at_rest{.markers = elements.markers};
    at_rest.states.assign(force->internal_states().size(), 0.0);
    const std::vector<double> rms(force->channels().size(), 0.01);
    const dynamics::RandomLaws laws =
        force->linearise_for_random_motion(at_rest.instant(), choose_branches(*force, at_rest), rms);
    if (!laws.rate_slopes.empty()) {
      ++num_dampers;
      const auto is_rate = [](const dynamics::Channel& one) {
        return one.role == dynamics::ChannelRole::kRate;
      };
      const auto channels = force->channels();
      CHECK(std::ssize(laws.rate_slopes) == std::count_if(channels.begin(), channels.end(), is_rate));
    }
    const auto& law = laws.states;
    if (!law) continue;
    ++num_linearised;
    const auto n = static_cast<Eigen::Index>(at_rest.states.size());
    CHECK(law->gain.size() == n);
    CHECK(law->decay.rows() == n);
    CHECK(law->decay.cols() == n);
    CHECK(law->gain.allFinite());
    CHECK(law->decay.allFinite());
  }
  CHECK(num_linearised > 0);
  CHECK(num_dampers > 0);
}

TEST_CASE("Linear laws of dampers give channels and forces the same power") {
  // Its slope changes the force channel and the power of the wrenches by slope times rate, which is what is
  // dissipated.
  const Elements elements;
  test::RandomNumbers random(7);
  for (const auto& force : elements.model.forces) {
    const MarkerPair pair = elements.move(*force, random);
    const std::vector<int> branches = choose_branches(*force, pair);
    const auto num_slopes =
        force->linearise_for_random_motion(pair.instant(), branches, {}).rate_slopes.size();
    if (num_slopes == 0) continue;
    CAPTURE(force->name, force->kind());
    const auto calc_power = [&](const std::vector<double>& slopes) {
      dynamics::Instant now = pair.instant();
      now.rate_slopes = slopes;
      std::vector<dynamics::Wrench> wrenches(now.markers.size());
      const double dissipated = force->add_wrenches(now, branches, wrenches).dissipated;
      double power = 0.0;
      for (std::size_t m = 0; m < wrenches.size(); ++m)
        power += wrenches[m].force.dot(now.markers[m].v) + wrenches[m].torque * now.markers[m].omega;
      return std::pair{power, dissipated};
    };
    std::vector<double> slopes(num_slopes, 0.0), values(force->channels().size());
    const auto [power_without, dissipated_without] = calc_power(slopes);
    force->calc_channels(pair.instant(), branches, values);
    double expected = 0.0;
    std::size_t k = 0;
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (force->channels()[c].role != dynamics::ChannelRole::kRate) continue;
      slopes[k] = 100.0 + 10.0 * static_cast<double>(k);
      expected += slopes[k] * values[c] * values[c];
      ++k;
    }
    const auto [power, dissipated] = calc_power(slopes);
    CHECK(dissipated - dissipated_without == Approx(expected).epsilon(1e-9));
    CHECK(power_without - power == Approx(expected).epsilon(1e-9));
  }
}

#include "reduce/modes/wanted_modes.h"

#include <cmath>

#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using support::InputError;
using testing::message_of;

constexpr auto kWhere = [] { return support::SourceLocation{.path = "frame.toml", .line = 7, .column = 3}; };

Superelement reduce_star(const WantedModes& request) {
  return make_superelement(testing::make_design(testing::make_star(2, 0.3, 5), {0.0, 0.0}, request));
}

TEST_CASE("a count takes the lowest modes, and is refused where it takes part of a cluster") {
  const Superelement all = reduce_star({});
  REQUIRE(all.num_modes() == 30);
  const Superelement four = reduce_star({.wanted = ModeCount{4}});
  CHECK((four.frequency_hz - all.frequency_hz.head(4)).cwiseAbs().maxCoeff() < 1e-9 * all.frequency_hz(3));
  const std::string message =
      message_of<InputError>([] { reduce_star({.wanted = ModeCount{3}, .where = kWhere()}); });
  CHECK_THAT(message,
             Contains("frame.toml:7:3: error: 3 modes would take part of the cluster of modes 3 … 4"));
  CHECK_THAT(message, Contains("take 2 or 4 modes"));
}

TEST_CASE("a highest frequency takes every mode up to and with it") {
  const Superelement all = reduce_star({});
  const auto num_up_to = [](double frequency_hz) {
    return reduce_star({.wanted = ModesUpTo{frequency_hz}}).num_modes();
  };
  CHECK(num_up_to(0.5 * (all.frequency_hz(3) + all.frequency_hz(4))) == 4);
  CHECK(num_up_to(all.frequency_hz(5)) == 6);
  CHECK(num_up_to(all.frequency_hz(5) * (1.0 - 1e-5)) == 4);
  CHECK(num_up_to(2.0 * all.frequency_hz(29)) == 30);
  const std::string message =
      message_of<InputError>([] { reduce_star({.wanted = ModesUpTo{0.5}, .where = kWhere()}); });
  CHECK_THAT(message,
             Contains("frame.toml:7:3: error: no mode has a frequency up to 0.5 Hz; the lowest is at"));
}

TEST_CASE("mode numbers take part of a cluster if told to, in the cluster's canonical basis") {
  const Superelement all = reduce_star({});
  const Superelement some = reduce_star({.wanted = ModeNumbers{{2, 5}}});
  REQUIRE(some.num_modes() == 2);
  CHECK(some.frequency_hz(0) == Approx(all.frequency_hz(1)).epsilon(1e-11));
  CHECK((some.shapes.col(0) - all.shapes.col(1)).cwiseAbs().maxCoeff() <
        1e-10 * all.shapes.cwiseAbs().maxCoeff());
  CHECK((some.shapes.col(1) - all.shapes.col(4)).cwiseAbs().maxCoeff() <
        1e-10 * all.shapes.cwiseAbs().maxCoeff());
  CHECK(some.cluster == Eigen::Vector2i(all.cluster(1), all.cluster(4)));
}

TEST_CASE("more modes than freedoms are refused with both numbers") {
  const WantedModes count{.wanted = ModeCount{31}, .where = kWhere()};
  const WantedModes numbers{.wanted = ModeNumbers{{1, 40}}, .where = kWhere()};
  CHECK_THAT(message_of<InputError>([&] { reduce_star(count); }),
             Contains("frame.toml:7:3: error: mode 31 was asked for, but the frame has 30 elastic freedoms"));
  CHECK_THAT(message_of<InputError>([&] { reduce_star(numbers); }), Contains("mode 40 was asked for"));
}

TEST_CASE("damping ratios are one for all or one for each mode") {
  Design design = testing::make_design(testing::make_star(2, 0.3, 5), {0.0, 0.0}, {.wanted = ModeCount{4}});
  design.damping_ratio = {0.01, 0.02, 0.03, 0.04};
  const Superelement s = make_superelement(design);
  CHECK(s.damping_ratio(2) == 0.03);
  CHECK(s.damping(2, 2) == Approx(4.0 * M_PI * 0.03 * s.frequency_hz(2)));
  CHECK(s.damping(2, 3) == 0.0);
  design.damping_ratio.pop_back();
  design.damping_where = kWhere();
  CHECK_THAT(message_of<InputError>([&] { make_superelement(design); }),
             Contains("frame.toml:7:3: error: 3 damping ratios for 4 modes"));
}

TEST_CASE("all modes of a frame too large for the dense solution are refused") {
  const Design design =
      testing::make_design(testing::make_star(2, 0.3, 501), {0.0, 0.0}, {.where = kWhere()});
  CHECK_THAT(message_of<InputError>([&] { make_superelement(design); }),
             Contains("that is offered up to 3000"));
}

}  // namespace
}  // namespace sprung::reduce

#include "dynamics/input/mode_selection.h"

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using test::input_error_of;

namespace {

// The frame of the tests' cart has modes at 5, 5, 12, 20 Hz.
dynamics::ModeSelection select(const std::string& lines) {
  const support::TomlDocument document = support::TomlDocument::parse("[modes]\n" + lines, "run.toml");
  return dynamics::resolve_modes(dynamics::read_modes(document.root().at("modes").table()),
                                 test::read_cart(test::cart_text()));
}

dynamics::ModalDamping damp(const std::string& lines, const dynamics::ModeSelection& selection) {
  const support::TomlDocument document =
      support::TomlDocument::parse("[modal_damping]\n" + lines, "run.toml");
  return dynamics::resolve_modal_damping(
      dynamics::read_modal_damping(document.root().at("modal_damping").table()), selection,
      test::read_cart(test::cart_text()));
}

std::string error_of(const std::string& lines) {
  return input_error_of([&] { select(lines); });
}

}  // namespace

TEST_CASE("Modes are selected by a count, by numbers or all of them") {
  using Numbers = std::vector<int>;
  CHECK(select("frame = 2").at("frame") == Numbers{1, 2});
  CHECK(select("frame = 3").at("frame") == Numbers{1, 2, 3});
  CHECK(select("frame = [2, 4]").at("frame") == Numbers{2, 4});
  CHECK(select("frame = \"all\"").at("frame") == Numbers{1, 2, 3, 4});
  CHECK(select("frame = \"auto\"").at("frame") ==
        Numbers{1, 2, 3, 4});  // all modes, as candidates for the choice
  CHECK(select("frame = 0").empty());
  CHECK(select("frame = []").empty());
  CHECK(select("").empty());
}

TEST_CASE("A count does not separate modes of equal frequency, numbers may") {
  CHECK(error_of("frame = 1") ==
        "run.toml:2:9: error: 'modes.frame' is 1, which separates modes 1 to 2 of one frequency, 5 Hz; "
        "take 0 or 2 modes, or list their numbers");
  CHECK(select("frame = [1]").at("frame") == std::vector<int>{1});
}

TEST_CASE("Modes that the superelement lacks are refused") {
  CHECK(error_of("frame = 5") ==
        "run.toml:2:9: error: 'modes.frame' asks for 5 modes, but superelement 'frame' has 4 modes");
  CHECK(error_of("frame = [1, 9]") ==
        "run.toml:2:9: error: 'modes.frame' asks for mode 9, but superelement 'frame' has 4 modes");
  CHECK(error_of("frame = -1") ==
        "run.toml:2:9: error: 'modes.frame' must be an integer from 0 to 2147483647, got -1");
  CHECK(error_of("frame = [0]") ==
        "run.toml:2:10: error: 'modes.frame.0' must be an integer from 1 to 2147483647, got 0");
  CHECK(error_of("frame = [3, 3]") ==
        "run.toml:2:13: error: 'modes.frame.1' must ascend: mode 3 comes after mode 3");
  CHECK(error_of("frame = 5000000000") ==
        "run.toml:2:9: error: 'modes.frame' must be an integer from 0 to 2147483647, got 5000000000");
}

TEST_CASE("Selections of wrong type, or of unknown or rigid bodies, are refused") {
  CHECK(error_of("frame = \"some\"") ==
        "run.toml:2:9: error: 'modes.frame' must be a number of modes, a list of mode numbers, \"all\", "
        "\"auto\" or \"certified\", got \"some\"");
  CHECK(error_of("frame = 2.5") ==
        "run.toml:2:9: error: 'modes.frame' must be a number of modes, a list of mode numbers, \"all\", "
        "\"auto\" or \"certified\"");
  CHECK(
      error_of("frame = \"certified\"") ==
      "run.toml:2:9: error: 'modes.frame' asks for the certified basis of superelement 'frame', which has no "
      "certificate; make it with the basis \"free\"");
  CHECK(error_of("frime = 2") ==
        "run.toml:2:9: error: 'modes.frime' is about no body of the vehicle: there is no 'frime' (did you "
        "mean 'frame'?)");
  CHECK(error_of("arm = 2") ==
        "run.toml:2:7: error: 'modes.arm' is about the modes of body 'arm', which has no superelement");
}

TEST_CASE("Damping ratios replace the superelement's, one for all modes or one for each") {
  const dynamics::ModeSelection three{{"frame", {1, 2, 4}}};
  CHECK(damp("frame = 0.02", three).at("frame") == std::vector<double>{0.02});
  CHECK(damp("frame = [0.0, 0.1, 0.02]", three).at("frame") == std::vector<double>{0.0, 0.1, 0.02});
  CHECK(damp("frame = 0.02", {}).empty());
  CHECK(damp("", three).empty());
}

TEST_CASE("Damping ratios that fit no mode are refused") {
  const dynamics::ModeSelection three{{"frame", {1, 2, 4}}};
  CHECK(input_error_of([&] { damp("frame = [0.1, 0.2]", three); }) ==
        "run.toml:2:9: error: 'modal_damping.frame' must be one ratio, or one for each of the 3 available "
        "modes; got 2");
  CHECK(input_error_of([&] { damp("frame = -0.1", three); }) ==
        "run.toml:2:9: error: 'modal_damping.frame' must be ≥ 0 and ≤ 1000000, got -0.1");
  CHECK(
      input_error_of([&] { damp("arm = 0.1", three); }) ==
      "run.toml:2:7: error: 'modal_damping.arm' is about the modes of body 'arm', which has no superelement");
  CHECK(input_error_of([&] { damp("frome = 0.1", three); }) ==
        "run.toml:2:9: error: 'modal_damping.frome' is about no body of the vehicle: there is no 'frome' "
        "(did you mean 'frame'?)");
}

TEST_CASE("Damping of modes that the program chooses is that of the modes it keeps") {
  const dynamics::ModeSelection all = select("frame = \"auto\"");
  const dynamics::ModeSelection kept{{"frame", {1, 2, 4}}};
  CHECK(dynamics::keep_damping(damp("frame = [0.1, 0.2, 0.3, 0.4]", all), all, kept).at("frame") ==
        std::vector<double>{0.1, 0.2, 0.4});
  CHECK(dynamics::keep_damping(damp("frame = 0.1", all), all, kept).at("frame") == std::vector<double>{0.1});
  CHECK(dynamics::keep_damping(damp("frame = 0.1", all), all, {}).empty());
}

TEST_CASE("The tolerance of the choice has a range") {
  const auto read = [](const std::string& line) {
    const support::TomlDocument document = support::TomlDocument::parse("[mode_choice]\n" + line, "run.toml");
    return dynamics::read_mode_choice(document.root().at("mode_choice").table()).tolerance;
  };
  CHECK(read("") == 0.01);
  CHECK(read("tolerance = 0.0") == 0.0);
  CHECK(input_error_of([&] { read("tolerance = 0.6"); }) ==
        "run.toml:2:13: error: 'mode_choice.tolerance' must be ≥ 0 and ≤ 0.5, got 0.6");
  CHECK_THAT(input_error_of([&] { read("tolerence = 0.1"); }), Contains("tolerence"));
}

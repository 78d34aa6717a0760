#include "dynamics/element_input/history_input.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "dynamics/element_input/time_function_input.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"
#include "tests/dynamics/measured/rpc3_writer.h"

using namespace sprung;
using dynamics::HistoryFiles;
using dynamics::TimeFunction;
using dynamics::TimeFunctionUse;

namespace {

using std::numbers::pi;

const std::string kFile = "time [ms],front [mm],rear [mm]\n1000,10,-5\n1500,30,0\n2500,20,5\n";

// A function of time of unit m from a history in the folder "measured".
struct Reading {
  HistoryFiles files{"measured"};
  TimeFunction function;

  Reading(const std::string& content, const std::string& keys,
          TimeFunctionUse use = TimeFunctionUse::kForce) {
    std::filesystem::create_directories("measured");
    std::ofstream("measured/rig.csv") << content;
    const support::TomlDocument document =
        support::TomlDocument::parse("f = { history = { file = \"rig.csv\", " + keys + " } }\n", "v.toml");
    function = dynamics::read_time_function(document.root().at("f"), "m", use, files);
  }
};

std::string error_of(const std::string& content, const std::string& keys,
                     TimeFunctionUse use = TimeFunctionUse::kForce) {
  return test::input_error_of([&] { Reading(content, keys, use); });
}

std::string check_error(const std::string& keys, double to) {
  const Reading reading(kFile, keys);
  return test::input_error_of([&] { dynamics::check_histories(reading.files.used(), to); });
}

}  // namespace

TEST_CASE("A history is a column of a file, in the units that it states, scaled and shifted") {
  const Reading plain(kFile, "channel = \"front\"");
  CHECK(plain.function.value(1.0) == Approx(0.010).epsilon(1e-14));
  CHECK(plain.function.value(1.25) == Approx(0.020).epsilon(1e-14));
  CHECK(plain.function.value(2.0) == Approx(0.025).epsilon(1e-14));
  const Reading changed(kFile, "channel = \"rear\", start = 0.0, scale = -2.0, offset = 0.1");
  CHECK(changed.function.value(0.0) == Approx(0.11).epsilon(1e-14));
  CHECK(changed.function.value(1.5) == Approx(0.09).epsilon(1e-14));
  const Reading in_cm(kFile, "channel = \"front\", unit = \"cm\"");
  CHECK(in_cm.function.value(1.0) == Approx(0.10).epsilon(1e-14));
  // Another column may hold the times.
  const Reading by_column("z,clock\n1,0\n3,2\n", "channel = \"z\", time = \"clock\"");
  CHECK(by_column.function.value(1.0) == Approx(2.0).epsilon(1e-14));
}

TEST_CASE("The integrator stops at each sample of straight lines, and at the ends alone of a smooth curve") {
  const Reading lines(kFile, "channel = \"front\"");
  CHECK(lines.function.breaks().size() == 3);
  const Reading smooth(kFile, "channel = \"front\", interpolation = \"smooth\"");
  CHECK(smooth.function.breaks().size() == 2);
  CHECK(smooth.function.details().shortest() == Approx(0.5).epsilon(1e-12));
  CHECK(smooth.function.value(1.5) == Approx(0.030).epsilon(1e-12));
  CHECK(smooth.function.rate(1.0) == Approx(0.0).margin(1e-12));
  // A motion is smooth without being told so, and cannot be otherwise.
  const Reading motion(kFile, "channel = \"front\"", TimeFunctionUse::kMotion);
  CHECK(motion.function.breaks().size() == 2);
  CHECK_THAT(error_of(kFile, "channel = \"front\", interpolation = \"linear\"", TimeFunctionUse::kMotion),
             Contains("'f' must not jump, as it moves bodies: its rate is 0 m/s before t = 1 s"));
}

TEST_CASE("A smooth history of a sine has its values, rates and accelerations between the samples") {
  std::string content = "t,z\n";
  constexpr double kSpacing = 0.01;
  for (int i = 0; i <= 400; ++i) {
    const double t = kSpacing * i;
    content += std::to_string(t) + "," + fmt::format("{:.17g}", std::sin(2.0 * pi * t)) + "\n";
  }
  const Reading reading(content, "channel = \"z\", interpolation = \"smooth\"");
  // 5/384 h⁴ max|f⁗| of the value, h³/24 max|f⁗| of the rate, 3/8 h² max|f⁗| of the acceleration [Hall &
  // Meyer 1976], far from the ends, where the curve is level
  const double fourth = std::pow(2.0 * pi, 4);
  for (double t = 1.0; t < 3.0; t += 0.0173) {
    CHECK(reading.function.value(t) == Approx(std::sin(2.0 * pi * t)).margin(5.0 / 384.0 * 1e-8 * fourth));
    CHECK(reading.function.rate(t) == Approx(2.0 * pi * std::cos(2.0 * pi * t)).margin(1e-6 / 24.0 * fourth));
    CHECK(reading.function.acceleration(t) ==
          Approx(-4.0 * pi * pi * std::sin(2.0 * pi * t)).margin(3.0 / 8.0 * 1e-4 * fourth));
  }
}

TEST_CASE("A history in RPC III has equal time steps from 0 on, its channels by description or number") {
  std::filesystem::create_directories("measured");
  test::Rpc3History history{.group = 4, .time_step = 0.25, .scales = {0.5, 2.0}, .samples = {{}, {}}};
  for (int k = 0; k < 8; ++k) {
    history.samples[0].push_back(k);
    history.samples[1].push_back(-k);
  }
  const std::string bytes = test::format_rpc3(history);
  // 3.5 samples at 0.875 s; the unit is mm
  CHECK(Reading(bytes, "channel = \"post 1\"").function.value(0.875) == Approx(3.5 * 0.5e-3).epsilon(1e-14));
  CHECK(Reading(bytes, "channel = \"CHAN_2\"").function.value(0.875) == Approx(-3.5 * 2e-3).epsilon(1e-14));
  CHECK(error_of(bytes, "channel = \"post 3\"") ==
        "v.toml:1:47: error: 'f.history.channel' is in no column or channel of the file, 'post 3' (did you "
        "mean 'post "
        "1'?); it has 'post 1', 'post 2'");
  CHECK(error_of(bytes, "channel = \"post 1\", time = \"t\"") ==
        "v.toml:1:64: error: 'f.history.time' must be left out: an RPC III file has equal time steps");
  history.changes = {{"DESC.CHAN_2", "post 1"}};
  CHECK_THAT(error_of(test::format_rpc3(history), "channel = \"post 1\""),
             Contains("is the name of the channels 1 and 2 of the file; write CHAN_1 or CHAN_2"));
}

TEST_CASE("A run must not need a history outside of its samples unless a key says what holds there") {
  CHECK(check_error("channel = \"front\", start = 0.0", 1.5) == "no error");
  CHECK(check_error("channel = \"front\", start = 0.0", 1.6) ==
        "v.toml:1:17: error: 'f.history' is known from 0 s to 1.5 s, but is needed until 1.6 s; say by "
        "'after' what "
        "holds there, \"hold\" or a number");
  CHECK(check_error("channel = \"front\"", 2.0) ==
        "v.toml:1:17: error: 'f.history' is known from 1 s to 2.5 s, but is needed from 0 s on; say by "
        "'before' what "
        "holds there, \"hold\" or a number");
  CHECK(check_error("channel = \"front\", before = \"hold\", after = 0.0", 9.0) == "no error");
  CHECK(check_error("channel = \"front\", start = -1.0", 0.0) == "no error");
  CHECK_THAT(error_of(kFile, "channel = \"front\", after = \"zero\""), Contains("'f.history.after'"));
}

TEST_CASE("Outside of the samples the nearest one holds, or the number that is given") {
  const Reading held(kFile, "channel = \"front\", before = \"hold\", after = \"hold\"");
  CHECK(held.function.value(0.0) == Approx(0.010).epsilon(1e-14));
  CHECK(held.function.value(5.0) == Approx(0.020).epsilon(1e-14));
  const Reading given(kFile, "channel = \"front\", before = 0.5, after = -1");
  CHECK(given.function.value(0.999) == 0.5);
  CHECK(given.function.value(1.0) == Approx(0.010).epsilon(1e-14));
  CHECK(given.function.value(2.499) == Approx(0.020).epsilon(1e-3));
  CHECK(given.function.value(2.501) == -1.0);
  // A motion cannot jump to it.
  CHECK_THAT(
      error_of(kFile, "channel = \"front\", after = 0.5", TimeFunctionUse::kMotion),
      Contains("must not jump, as it moves bodies: its value is 0.02 m before t = 2.5 s and 0.5 m after"));
}

TEST_CASE("A run that exceeds a history is told what holds instead") {
  const Reading reading(kFile, "channel = \"front\", before = \"hold\", after = 0.0");
  const std::vector<std::string> remarks = dynamics::list_history_remarks(reading.files.used(), 4.0);
  REQUIRE(remarks.size() == 2);
  CHECK(remarks[0] == "v.toml:1:17: 'f.history' begins at 1 s; until then its first value holds");
  CHECK(remarks[1] == "v.toml:1:17: 'f.history' ends at 2.5 s, the run at 4 s; from then on 0 holds");
  CHECK(dynamics::list_history_remarks(reading.files.used(), 2.5).size() == 1);
}

TEST_CASE("Samples of a smooth history that are much closer than the others are told") {
  const std::string content = "t,z\n0,0\n1,1\n2,0\n2.01,0\n3,1\n4,0\n";  // on average 0.8 s
  const auto remarks_on = [&](const std::string& keys) {
    return dynamics::list_history_remarks(Reading(content, keys).files.used(), 4.0);
  };
  CHECK(remarks_on("channel = \"z\"").empty());
  const std::vector<std::string> remarks = remarks_on("channel = \"z\", interpolation = \"smooth\"");
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0] ==
        "v.toml:1:17: 'f.history' has samples 0.01 s apart, where the mean is 0.8 s: steps near them "
        "are no longer");
}

TEST_CASE("A smooth history that swings far beyond its samples is told") {
  // A jump by 1 within 1e-6 s. The spline through points 0, 1 and 2 with the slope s at the close ones passes
  // the middle of the second interval at 1 + s (1 s)/8 or so: far beyond 1.
  const std::string content = "t,z\n0,0\n1,0\n1.000001,1\n2,1\n";
  const auto remarks_on = [&](const std::string& interpolation) {
    const std::string keys = "channel = \"z\", interpolation = \"" + interpolation + "\"";
    return dynamics::list_history_remarks(Reading(content, keys).files.used(), 2.0);
  };
  CHECK(remarks_on("linear").empty());
  const std::vector<std::string> remarks = remarks_on("smooth");
  REQUIRE(remarks.size() == 2);
  CHECK_THAT(remarks[1], Contains("v.toml:1:17: 'f.history' swings out beyond its samples by ") &&
                             Contains("e+05 times their range"));
}

TEST_CASE("What has been read is known by file, channel and content") {
  const Reading reading(kFile, "channel = \"rear\", scale = 3.0");
  REQUIRE(reading.files.used().size() == 1);
  const dynamics::HistoryUse& use = reading.files.used().front();
  CHECK(use.key == "f.history");
  CHECK(use.file == "rig.csv");
  CHECK(use.channel == "rear");
  CHECK(use.unit == "mm");
  CHECK(use.scale == 3.0);
  CHECK(use.from == 1.0);
  CHECK(use.to == 2.5);
  CHECK(use.hash.size() == 64);
  CHECK(use.hash != Reading(kFile + "\n", "channel = \"rear\"").files.used().front().hash);
}

TEST_CASE("Histories that cannot be used are refused where they are named") {
  CHECK(
      error_of(kFile, "channel = \"frnt\"") ==
      "v.toml:1:47: error: 'f.history.channel' is in no column or channel of the file, 'frnt' (did you mean "
      "'front'?); it has 'time', 'front', 'rear'");
  CHECK(error_of(kFile, "channel = \"time\"") ==
        "v.toml:1:47: error: 'f.history.channel' must not be the column of the times");
  CHECK(error_of(kFile, "channel = \"front\", unit = \"kN\"") ==
        "v.toml:1:63: error: 'f.history.unit' is in 'kN', expected one of m, mm, cm, um, µm, km, in, ft; "
        "'unit' says "
        "in which unit to take it");
  CHECK_THAT(error_of("t,z [bar]\n0,1\n1,2\n", "channel = \"z\""),
             Contains("'f.history.channel' is in 'bar'"));
  CHECK_THAT(error_of("t [mm],z\n0,1\n1,2\n", "channel = \"z\""),
             Contains("is in 'mm', expected one of s, sec"));
  CHECK(error_of("t,z\n0,1\n0.2,2\n0.2,3\n", "channel = \"z\"") ==
        "measured/rig.csv:4:1: error: 't' must ascend by at least 1e-09 s, got 0.2 s after 0.2 s");
  CHECK(error_of("t,z\n0,1\n0.2,nan\n", "channel = \"z\"") ==
        "measured/rig.csv:3:5: error: 'z' must be a finite number within ±1e+15, got 'nan'");
  CHECK_THAT(error_of(kFile, "channel = \"front\", scale = 1e20"), Contains("must stay within ±1e+15 m"));
  CHECK(error_of(kFile, "channel = \"front\", start = 1e17") ==
        "v.toml:1:64: error: 'f.history.start' must be ≤ 1000000000 s, got 1e+17");
  CHECK_THAT(error_of("t,z\n0,0\n2e-9,1\n", "channel = \"z\", start = 1e9"),
             Contains("got 1000000000 s in sample 2"));
  CHECK_THAT(error_of(kFile, "chanel = \"front\""), Contains("chanel"));
  HistoryFiles files("measured");
  const support::TomlDocument document =
      support::TomlDocument::parse("f = { history = { file = \"none.csv\", channel = \"z\" } }\n", "v.toml");
  CHECK(test::input_error_of([&] {
          dynamics::read_time_function(document.root().at("f"), "m", TimeFunctionUse::kForce, files);
        }) == "v.toml:1:26: error: 'f.history.file' names no file, measured/none.csv");
}

TEST_CASE("A smooth history of whole periods does not jump at its ends by its rounding") {
  // The breaks and an eighth of the duration are whole periods, where value and rate are zero.
  std::string content = "time,z\n";
  for (int i = 0; i <= 160; ++i) {
    content +=
        std::to_string(0.05 * i) + "," + std::to_string(0.01 * (1.0 - std::cos(2.0 * pi * 0.05 * i))) + "\n";
  }
  CHECK(error_of(content, "channel = \"z\"", TimeFunctionUse::kMotion) == "no error");
  CHECK_THAT(error_of(content, "channel = \"z\", before = 1e-6", TimeFunctionUse::kMotion),
             Contains("must not jump"));
}

TEST_CASE("A name that is the number of another channel is refused") {
  test::Rpc3History history{
      .scales = {}, .samples = {{0, 1, 2, 3}, {4, 5, 6, 7}}, .changes = {{"DESC.CHAN_1", "CHAN_2"}}};
  CHECK_THAT(error_of(test::format_rpc3(history), "channel = \"CHAN_2\""),
             Contains("is channel 2 by its number, but also the name of channel 1"));
}

TEST_CASE("Keys of a history say what they accept") {
  CHECK_THAT(error_of(kFile, "channel = \"front\", before = \"zero\""),
             Contains("must be \"hold\" or a number, got 'zero'"));
  const std::string message = error_of("x [mm],z\n0,1\n1,2\n", "channel = \"z\"");
  CHECK_THAT(message,
             Contains("is in 'mm', expected one of s, sec, ms, min, as it is the column of the times"));
}

namespace {

// A function in m that contains histories of kFile, at the place of "{}".
TimeFunction read_around(HistoryFiles& files, const std::string& function) {
  std::filesystem::create_directories("measured");
  std::ofstream("measured/rig.csv") << kFile;
  std::ofstream("measured/share.csv") << "time [s],share [%],push [kN]\n0,50,1\n9,50,1\n";
  const support::TomlDocument document = support::TomlDocument::parse("f = " + function + "\n", "v.toml");
  return dynamics::read_time_function(document.root().at("f"), "m", TimeFunctionUse::kForce, files);
}

constexpr const char* kFront = "{ history = { file = \"rig.csv\", channel = \"front\" } }";
constexpr const char* kShare = "{ history = { file = \"share.csv\", channel = \"share\" } }";
constexpr const char* kPush = "{ history = { file = \"share.csv\", channel = \"push\" } }";

}  // namespace

TEST_CASE("One factor of a product may have the unit of the function, the others are pure numbers") {
  // 10 mm at 1 s, of which 50 %.
  HistoryFiles files{"measured"};
  CHECK(read_around(files, fmt::format("{{ product = [{}, {}] }}", kFront, kShare)).value(1.0) ==
        Approx(0.005).epsilon(1e-14));
  const auto refused = [&](const std::string& a, const std::string& b) {
    return test::input_error_of([&] { read_around(files, fmt::format("{{ product = [{}, {}] }}", a, b)); });
  };
  CHECK_THAT(refused(kShare, kPush),
             Contains("v.toml:1:") && Contains("has a history in 'kN', expected one of"));
  CHECK_THAT(refused(kFront, kFront), Contains("is the second factor with a unit; a product in m has one"));
  CHECK_THAT(refused(kFront, fmt::format("{{ product = [2.0, {}] }}", kFront)), Contains("second factor"));
}

TEST_CASE("A history in pieces has to cover its piece only") {
  HistoryFiles files{"measured"};  // from 1 s to 2.5 s
  const auto read = [&](double from, double until) {
    files = HistoryFiles("measured");
    read_around(files,
                fmt::format("{{ pieces = [{{ until = {}, function = 0.0 }}, {{ until = {}, function = {} "
                            "}}, {{ function = 0.0 }}] }}",
                            from, until, kFront));
    return test::input_error_of([&] { dynamics::check_histories(files.used(), 10.0); });
  };
  CHECK(read(1.0, 2.5) == "no error");
  CHECK(dynamics::list_history_remarks(files.used(), 10.0).empty());
  CHECK_THAT(read(0.9, 2.5), Contains("is known from 1 s to 2.5 s, but is needed from 0.9 s on"));
  CHECK_THAT(read(1.0, 2.6), Contains("but is needed until 2.6 s"));
  // A piece behind the end of the run needs nothing.
  CHECK_NOTHROW(dynamics::check_histories(files.used(), 0.5));
}

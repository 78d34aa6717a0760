#include "dynamics/input/road_input.h"

#include <cmath>
#include <fstream>
#include <numbers>

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using test::input_error_of;

namespace {

dynamics::RoadDescription read(const std::string& lines) {
  const support::TomlDocument document = support::TomlDocument::parse("[road]\n" + lines, "run.toml");
  return dynamics::read_road(document.root().at("road").table(), "roads");
}

std::string error_of(const std::string& lines) {
  return input_error_of([&] { read(lines); });
}

// A road table with this content, in the folder that `read` looks in.
std::unique_ptr<dynamics::Road> make_table(const std::string& content) {
  std::filesystem::create_directories("roads");
  std::ofstream("roads/field.txt") << content;
  return dynamics::make_road(read("shape = \"table\"\nstart = 2.0\nfile = \"field.txt\""));
}

std::string error_of_table(const std::string& content) {
  return input_error_of([&] { make_table(content); });
}

}  // namespace

TEST_CASE("The shapes of a bump have their own heights at a quarter of their length") {
  const std::string rest = "start = 1.0\nlength = 0.4\nheight = 0.2";
  const auto height_of = [&](const std::string& shape, double s) {
    return dynamics::make_road(read("shape = \"" + shape + "\"\n" + rest))->height(s);
  };
  const double s = 1.1;
  CHECK(height_of("half-sine", s) == Approx(0.2 * std::sin(0.25 * std::numbers::pi)).epsilon(1e-12));
  CHECK(height_of("haversine", s) == Approx(0.1).epsilon(1e-12));
  CHECK(height_of("triangle", s) == Approx(0.1).epsilon(1e-12));
  CHECK(height_of("ramp", s) == Approx(0.05).epsilon(1e-12));
  CHECK(height_of("ramp", 3.0) == Approx(0.2).epsilon(1e-12));
  CHECK(height_of("half-sine", 3.0) == 0.0);
}

TEST_CASE("A road without features is flat") {
  CHECK(dynamics::make_road(read("shape = \"flat\""))->height(17.0) == 0.0);
  CHECK(dynamics::make_road(dynamics::RoadDescription{})->height(17.0) == 0.0);
}

TEST_CASE("A road table is read with comments, blanks and commas, and begins at the run's start") {
  const std::unique_ptr<dynamics::Road> road =
      make_table("# s h\n10.0 0.0\r\n10.5, 0.03 # crest\n\n  11.25\t-0.02\n12,0.01");
  CHECK(road->height(1.9) == 0.0);
  CHECK(road->height(2.5) == Approx(0.03).epsilon(1e-12));
  CHECK(road->height(3.25) == Approx(-0.02).epsilon(1e-12));
  CHECK(road->height(4.0) == Approx(0.01).epsilon(1e-12));
  CHECK(road->height(9.0) == Approx(0.01).epsilon(1e-12));
}

TEST_CASE("Keys of a road that are missing, unknown or have a bad value are refused") {
  CHECK(error_of("start = 1.0") == "run.toml:1:1: error: missing key 'shape' in 'road'");
  CHECK(error_of("shape = \"half-sin\"") ==
        "run.toml:2:9: error: 'road.shape' must be one of \"flat\", \"half-sine\", \"haversine\", "
        "\"triangle\", \"ramp\", \"random\", \"table\", \"opencrg\"; got a string \"half-sin\" (did you mean "
        "'half-sine'?)");
  CHECK(error_of("shape = \"flat\"\nstart = 1.0") ==
        "run.toml:3:1: error: unknown key 'start' in 'road' (known keys: shape)");
  CHECK(error_of("shape = \"ramp\"\nstart = -1.0\nlength = 0.4\nheight = 0.2") ==
        "run.toml:3:9: error: 'road.start' must be ≥ 0 m, got -1");
  CHECK(error_of("shape = \"ramp\"\nstart = 1.0\nlength = 0.0\nheight = 0.2") ==
        "run.toml:4:10: error: 'road.length' must be > 0 m, got 0");
  CHECK(error_of("shape = \"ramp\"\nstart = 1.0\nlength = 0.4") ==
        "run.toml:1:1: error: missing key 'height' in 'road'");
  CHECK(error_of("shape = \"table\"\nstart = 1.0") == "run.toml:1:1: error: missing key 'file' in 'road'");
}

TEST_CASE("A road table may begin with the mark of byte order that spreadsheets write") {
  CHECK(make_table("\xEF\xBB\xBF"
                   "0,0\r\n1,0.1\r\n")
            ->height(3.0) == Approx(0.1).epsilon(1e-12));
}

TEST_CASE("A fault in a road table is found at its line and column") {
  CHECK(error_of_table("0 0\n1 0.1m\n") ==
        "roads/field.txt:2:3: error: the height must be a finite number [m], got '0.1m'");
  // Sizes of which no spline can be computed, found by road_fuzz.
  CHECK(error_of_table("0 0\n1 1e308\n")
            .find("distances and heights must be within ±1e+09 m, got 1 and 1e+308") != std::string::npos);
  CHECK(error_of_table("0 0\n1e-300 1\n").find("the distance must ascend by at least 1e-09 m") !=
        std::string::npos);
  CHECK(error_of_table("0 0\n1\n") ==
        "roads/field.txt:2:2: error: the height [m] is missing; a line is a distance and a height");
  CHECK(
      error_of_table("0 0\n1 0.1 0.2\n") ==
      "roads/field.txt:2:7: error: a line has two numbers, a distance and a height [m]; there is more here");
  CHECK(error_of_table("0 0\n1 nan\n") ==
        "roads/field.txt:2:3: error: the height must be a finite number [m], got 'nan'");
  CHECK(error_of_table("0 0\n 1 0.1\n 1 0.2\n") ==
        "roads/field.txt:3:2: error: the distance must ascend, got 1 m after 1 m");
  CHECK(error_of_table("# s h\n0 0.01\n1 0.1\n") ==
        "roads/field.txt:2:1: error: the first height must be 0 m, as the road before it, got 0.01");
  CHECK(error_of_table("0 0\n") == "roads/field.txt: error: a road needs at least 2 points, got 1");
}

TEST_CASE("A missing road table is named") {
  const dynamics::RoadDescription road = read("shape = \"table\"\nstart = 2.0\nfile = \"nowhere.txt\"");
  CHECK(input_error_of([&] { dynamics::make_road(road); }) ==
        "run.toml:4:8: error: there is no road file roads/nowhere.txt");
}

namespace {

std::unique_ptr<dynamics::Road> make_measured(const std::string& content, const std::string& keys,
                                              const std::string& shape = "table") {
  std::filesystem::create_directories("roads");
  std::ofstream("roads/measured.csv") << content;
  return dynamics::make_road(
      read("shape = \"" + shape + "\"\nstart = 2.0\nfile = \"measured.csv\"\n" + keys));
}

std::string error_of_measured(const std::string& content, const std::string& keys,
                              const std::string& shape = "table") {
  return input_error_of([&] { make_measured(content, keys, shape); });
}

const std::string kProfile =
    "chainage [km],left [mm],right [mm]\n0.010,5,-3\n0.0105,15,-3\n0.0125,25,7\n0.013,25,7\n";

const std::string kSurface =
    "$CT\n$\n$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 0.5\nLONG_SECTION_V_INCREMENT = "
    "1.0\n$\n$KD_Definition\n#:LRFI\n"
    "D:long section 1,m\nD:long section 2,m\nD:long section 3,m\n$\n$$$$\n"
    " 0.0100000 0.0200000 0.0300000\n 0.0200000 0.0200000 0.0500000\n 0.0400000 0.0000000 0.0500000\n";

}  // namespace

TEST_CASE("A measured profile is a column of a file, or the mean of several, from its first height on") {
  const auto left = make_measured(kProfile, "height = \"left\"");
  CHECK(left->height(1.9) == 0.0);
  CHECK(left->height(2.0) == Approx(0.0).margin(1e-15));
  CHECK(left->height(2.5) == Approx(0.010).epsilon(1e-12));  // unequal distances: 0.5 m, 2 m, 0.5 m
  CHECK(left->height(4.5) == Approx(0.020).epsilon(1e-12));
  CHECK(left->height(9.0) == Approx(0.020).epsilon(1e-12));
  const auto mean = make_measured(kProfile, "height = [\"left\", \"right\"]\ndistance = \"chainage\"");
  CHECK(mean->height(2.5) == Approx(0.005).epsilon(1e-12));
  CHECK(mean->height(4.5) == Approx(0.015).epsilon(1e-12));
}

TEST_CASE("Measured profiles that cannot be used are refused at their place") {
  CHECK(error_of_measured(kProfile, "height = \"middle\"") ==
        "run.toml:5:10: error: the file has no column 'middle'; it has 'chainage', 'left', 'right'");
  CHECK(error_of_measured(kProfile, "distance = \"chainage\"") ==
        "run.toml:5:12: error: 'road.distance' needs a 'height', the column of the heights");
  CHECK(error_of_measured("s,h [kN]\n0,0\n1,1\n", "height = \"h\"") ==
        "run.toml:5:10: error: the column 'h' is in 'kN', expected one of m, mm, cm, um, µm, km, in, ft");
  CHECK_THAT(error_of_measured("s,h\n0,0\n1,1\n1,2\n", "height = \"h\""),
             Contains("roads/measured.csv:4:1: error: 's' must ascend by at least 1e-09 m"));
  CHECK_THAT(error_of_measured("s,h\n0,0\n1,nan\n", "height = \"h\""),
             Contains("roads/measured.csv:3:3: error:"));
  CHECK_THAT(error_of_measured(kProfile, "height = []"), Contains("must name at least one column"));
  CHECK_THAT(error_of_measured(kProfile, "lateral = 0.0"), Contains("lateral"));
}

TEST_CASE("A road in OpenCRG is a line along it, or the mean of several") {
  const auto road = make_measured(kSurface, "lateral = 0.5", "opencrg");
  CHECK(road->height(2.0) == Approx(0.0).margin(1e-15));
  CHECK(road->height(2.5) == Approx(0.010).epsilon(1e-12));
  CHECK(road->height(3.0) == Approx(0.0).margin(1e-15));
  const auto mean = make_measured(kSurface, "lateral = [-1.0, 1.0]", "opencrg");
  CHECK(mean->height(2.5) == Approx(0.015).epsilon(1e-12));
  CHECK(mean->height(9.0) == Approx(0.025).epsilon(1e-12));
  CHECK(error_of_measured(kSurface, "lateral = [0.0, 1.5]", "opencrg") ==
        "run.toml:5:11: error: 'lateral' must lie on the road, from -1 m (right) to 1 m (left), got 1.5 m");
  CHECK_THAT(error_of_measured(kProfile, "lateral = 0.0", "opencrg"),
             Contains("roads/measured.csv: error: has no line '$$$$'"));
}

TEST_CASE("A column of a road has one use") {
  CHECK_THAT(error_of_measured("s,h\n0,0\n1,1\n", "height = \"s\""),
             Contains("'s' is the column of the distances"));
  CHECK_THAT(error_of_measured("s,h\n0,0\n1,1\n", "height = [\"h\", \"h\"]"),
             Contains("'height' names 'h' twice"));
  CHECK_THAT(error_of_table(std::string("0 0\n1 \0\n", 8)), Contains(":2:3: error: is no text"));
}

TEST_CASE("A random road has one level, a band and waves in it") {
  const auto random = [](const std::string& lines) {
    return "shape = \"random\"\nstart = 1.0\nlength = 50.0\n" + lines;
  };
  const std::unique_ptr<dynamics::Road> road = dynamics::make_road(read(random("class = \"C\"\nease = 5.0")));
  CHECK(road->height(0.9) == 0.0);
  CHECK(road->height(20.0) != 0.0);
  CHECK(road->height(51.0) == Approx(0.0).margin(1e-15));
  // A class alone says the shape, and the road begins at once.
  const dynamics::RoadDescription alone = read("class = \"C\"\nlength = 50.0\nease = 5.0");
  CHECK(alone.shape == "random");
  CHECK(dynamics::make_road(alone)->height(20.0) == road->height(21.0));
  CHECK(error_of("length = 50.0") == "run.toml:1:1: error: missing key 'shape' in 'road'");
  CHECK(dynamics::make_road(read(random("table = [[0.1, 1e-4], [2.0, 1e-7]]")))->height(20.0) != 0.0);
  CHECK(dynamics::make_road(read(random("rms = 0.01\nexponent = 3\nband = [0.1, 1.0]")))->height(20.0) !=
        0.0);
  CHECK(error_of(random("seed = 2")) ==
        "run.toml:1:1: error: 'road' must have either a 'class', or a 'density', or a 'table', or an 'rms'");
  CHECK(error_of(random("class = \"C\"\nrms = 0.1")) ==
        "run.toml:1:1: error: 'road' must have either a 'class', or a 'density', or a 'table', or an 'rms', "
        "not "
        "several of them");
  CHECK(error_of(random("class = \"K\"")) ==
        "run.toml:5:9: error: 'road.class' must be one of \"A\", \"B\", \"C\", \"D\", \"E\", \"F\", \"G\", "
        "\"H\"; got a string \"K\"");
  CHECK(error_of(random("rms = 0.1")) == "run.toml:1:1: error: 'road' must have a 'band' beside 'rms'");
  CHECK(error_of(random("class = \"C\"\nexponent = 3")) ==
        "run.toml:6:12: error: 'road.exponent' belongs to a power law, which 'class' does not give");
  CHECK(error_of(random("class = \"C\"\nband = [2.0, 1.0]")) ==
        "run.toml:6:8: error: 'road.band' must ascend, got 2 to 1 1/m");
  CHECK(error_of(random("class = \"C\"\nease = 25.0")) ==
        "run.toml:6:8: error: 'road.ease' must be below half of the length 50 m, got 25 m");
  CHECK(error_of(random("class = \"C\"\nseed = -1")).starts_with("run.toml:6:8: error: 'road.seed' must be"));
  CHECK(input_error_of([&] {
          dynamics::make_road(read(random("class = \"C\"\nband = [0.001, 0.002]")));
        }).find("'road' cannot be made: the band from 0.001 to 0.002 1/m holds no multiple of 1/50 m") !=
        std::string::npos);
}

TEST_CASE("A measured road that ends before the run, and a road left behind, are remarked on") {
  // From 2 m on, 3 m long: passed after 5 m/(2 m/s).
  const std::unique_ptr<dynamics::Road> road = make_table("0 0\n1 0.1\n3 0\n");
  const dynamics::RoadDescription table = read("shape = \"table\"\nstart = 2.0\nfile = \"field.txt\"");
  CHECK(dynamics::remark_on_road(table, *road, 2.0, 10.0) ==
        "run.toml:4:8: the road ends at 5 m, which the leading axle passes after 2.5 s of 10 s at the speed "
        "of the "
        "start; from there on it is level");
  CHECK(dynamics::describe_missed_road(table, *road, 2.0, 10.0) ==
        "the road ends at 5 m, which the leading axle passes after 2.5 s of 10 s at the speed of the start; "
        "from there on it is level");
  CHECK(dynamics::remark_on_road(table, *road, 2.0, 2.4).empty());
  CHECK(dynamics::remark_on_road(table, *road, -2.0, 10.0) ==
        "run.toml:2:9: the vehicle drives against its heading, so that it does not meet the road, which "
        "begins ahead of it");
  const dynamics::RoadDescription random =
      read("shape = \"random\"\nstart = 1.0\nlength = 50.0\nclass = \"C\"");
  CHECK_THAT(dynamics::remark_on_road(random, *dynamics::make_road(random), 10.0, 6.0),
             Contains("the road ends at 51 m, which the leading axle passes after 5.1 s of 6 s"));
  const dynamics::RoadDescription bump =
      read("shape = \"triangle\"\nstart = 1.0\nlength = 0.4\nheight = 0.2");
  CHECK(dynamics::remark_on_road(bump, *dynamics::make_road(bump), 2.0, 10.0).empty());
  const dynamics::RoadDescription flat = read("shape = \"flat\"");
  CHECK(dynamics::remark_on_road(flat, *dynamics::make_road(flat), -2.0, 10.0).empty());
}

TEST_CASE("A road that is not reached is told") {
  const dynamics::RoadDescription bump =
      read("shape = \"triangle\"\nstart = 1.0\nlength = 0.4\nheight = 0.2");
  const std::unique_ptr<dynamics::Road> road = dynamics::make_road(bump);
  CHECK(
      dynamics::describe_unreached_road(*road, 2.0, 0.4) ==
      "the road begins 1 m ahead of the leading axle, which does not reach it: at 'speed', 2 m/s, it covers "
      "0.8 m in 0.4 s");
  CHECK(dynamics::describe_unreached_road(*road, 2.0, 0.6).empty());
  CHECK_FALSE(dynamics::describe_unreached_road(*road, 0.0, 10.0).empty());
  CHECK(dynamics::describe_unreached_road(*dynamics::make_road(read("shape = \"flat\"")), 0.0, 1.0).empty());
}

#include "dynamics/measured/crg_file.h"

#include <fstream>

#include "tests/catch.h"

using namespace sprung;
using dynamics::CrgFile;

namespace {

// A straight road of five points, 0.5 m apart, three sections 1 m apart.
const std::string kParameters =
    "REFERENCE_LINE_INCREMENT = 0.5  ! m\n"
    "REFERENCE_LINE_START_U = 0.0\nREFERENCE_LINE_END_U = 2.0\n"
    "LONG_SECTION_V_RIGHT =-1.00\nLONG_SECTION_V_LEFT = 1.00\n";
const std::string kChannels =
    "#:LRFI\nU:reference line u,m,0,0.5\nD:long section 1,m ! right\nD:long section 2,m\nD:long section "
    "3,m\n";
const std::string kData =
    " 0.0100000 0.0200000 0.0300000\n 0.0110000-0.0200000 0.0300000\n 0.0120000 0.0000000 0.0300000\n"
    " 0.0130000 2.000e-02 0.0300000\n 0.0140000 0.0200000 *missing*\n";

std::string make_file(const std::string& parameters, const std::string& channels, const std::string& data) {
  return "* made for a test\n$CT ! text\nREFERENCE_LINE_START_S = 1, in words\n$!****\n$ROAD_CRG\n" +
         parameters + "$\n$KD_Definition\n" + channels + "$!****\n$$$$$$$$10$$$$$$$$20\n" + data;
}

CrgFile read(const std::string& text) {
  std::ofstream("road.crg") << text;
  return CrgFile::read("road.crg");
}

std::string error_of(const std::string& parameters, const std::string& channels = kChannels,
                     const std::string& data = kData, double lateral = -1.0) {
  try {
    read(make_file(parameters, channels, data)).read_heights(lateral);
    return "no error";
  } catch (const support::InputError& error) {
    return error.what();
  }
}

std::string replace(std::string text, const std::string& old_part, const std::string& new_part) {
  return text.replace(text.find(old_part), old_part.size(), new_part);
}

void check_heights(const CrgFile& file, double lateral, const std::vector<double>& expected) {
  const std::vector<double> heights = file.read_heights(lateral);
  REQUIRE(heights.size() == expected.size());
  for (std::size_t i = 0; i < heights.size(); ++i) CHECK(heights[i] == Approx(expected[i]).margin(1e-15));
}

}  // namespace

TEST_CASE("Heights are those of the sections, and linear between two of them") {
  const CrgFile file = read(make_file(kParameters, kChannels, kData));
  CHECK(file.increment() == 0.5);
  CHECK(file.rightmost() == -1.0);
  CHECK(file.leftmost() == 1.0);
  check_heights(file, -1.0, {0.010, 0.011, 0.012, 0.013, 0.014});
  check_heights(file, 0.0, {0.020, -0.020, 0.0, 0.020, 0.020});
  check_heights(file, -0.25, {0.0175, -0.01225, 0.003, 0.01825, 0.0185});
}

TEST_CASE("Sections have positions or numbers, and lie about the middle without a border") {
  const std::string positions =
      "#:LRFI\nD:long section at v = -1.500,m\nD:long section at v =  0.000,m\nD:long section at v = "
      "0.25,m\n";
  const CrgFile placed = read(make_file("REFERENCE_LINE_INCREMENT = 0.5\n", positions, kData));
  CHECK(placed.rightmost() == -1.5);
  CHECK(placed.leftmost() == 0.25);
  const std::string increment = "REFERENCE_LINE_INCREMENT = 0.5\nLONG_SECTION_V_INCREMENT = 0.7\n";
  CHECK(read(make_file(increment, kChannels, kData)).rightmost() == Approx(-0.7).epsilon(1e-14));
  CHECK(read(make_file(increment + "LONG_SECTION_V_LEFT = 1.0\n", kChannels, kData)).rightmost() ==
        Approx(-0.4).epsilon(1e-14));
}

TEST_CASE("Rows continue on further lines; double numbers take fields of 20 places") {
  const std::string channels =
      "#:LDFI\nD:reference line phi,rad\nD:long section 1,m\nD:long section 2,m\nD:long section 3,m\nD:long "
      "section 4,m\n";
  const std::string row =
      "            0.300000            0.010000            0.020000            0.030000\n"
      "            0.040000\n";
  const CrgFile file = read(make_file("REFERENCE_LINE_INCREMENT = 1\nLONG_SECTION_V_INCREMENT = 1\n",
                                      channels, replace(row, "  0.300000", "**unused**") + row + row));
  check_heights(file, 1.5, {0.04, 0.04, 0.04});
  check_heights(file, 1.0, {0.035, 0.035, 0.035});
}

TEST_CASE("Roads that are not straight and level along the reference line are refused") {
  CHECK(error_of(kParameters) == "no error");
  CHECK(error_of(kParameters + "REFERENCE_LINE_START_S = 0.02\n") ==
        "road.crg:11:1: error: 'REFERENCE_LINE_START_S' must be 0, got 0.02: a road that climbs or is banked "
        "along "
        "its reference line is not read");
  CHECK(
      error_of(kParameters + "REFERENCE_LINE_START_Z = 1.5\nREFERENCE_LINE_END_Z = 3\n") ==
      "road.crg:12:1: error: 'REFERENCE_LINE_END_Z' must be 1.5, as at the start, got 3: a road that climbs "
      "along its reference line is not read");
  CHECK(error_of(kParameters + "REFERENCE_LINE_START_PHI = 0\nREFERENCE_LINE_END_PHI = 0.5\n") ==
        "road.crg: error: turns from 0 to 0.5 rad along its reference line; only straight roads are read");
  const std::string turning =
      replace(kChannels, "D:long section 1,m ! right\n", "D:reference line phi,rad\n");
  CHECK_THAT(
      error_of(kParameters, replace(replace(turning, "section 2", "section 1"), "section 3", "section 2")),
      Contains("road.crg:22:1: error: the reference line turns from 0.011 to 0.012 rad"));
  CHECK_THAT(
      error_of(kParameters, kChannels + "D:reference line banking,m/m\n"),
      Contains("'D:reference line banking,m/m' is not read, only long sections and 'reference line phi'"));
}

TEST_CASE("OpenCRG files that cannot be read are refused at their place") {
  CHECK(error_of(kParameters, kChannels, kData, 1.0) ==
        "road.crg:24:21: error: a number must stand here, in a field of 10 places, got '*missing*'");
  CHECK(error_of(kParameters, replace(kChannels, "LRFI", "KRBI")) ==
        "road.crg:13:1: error: the format must be LRFI or LDFI, which are text, got 'KRBI'");
  CHECK_THAT(error_of(kParameters, replace(kChannels, "#:LRFI\n", "")), Contains("its data are binary"));
  CHECK(error_of(kParameters, kChannels, kData + " 0.0140000 0.0200000 0.0300000\n") ==
        "road.crg: error: has 6 rows of data, but 'REFERENCE_LINE_END_U' and '_INCREMENT' say 5");
  CHECK_THAT(error_of(kParameters, kChannels, " 0.0100000 0.0200000 0.0300000\n"),
             Contains("at least 2 rows of data"));
  CHECK_THAT(error_of(kParameters, kChannels, replace(kData, " 0.0120000", " nan      ")),
             Contains("road.crg:22:1: error: a number must stand here"));
  CHECK_THAT(error_of(replace(kParameters, "= 0.5 ", "= -0.5 ")), Contains("must be > 0 m, got -0.5"));
  CHECK_THAT(error_of(replace(kParameters, "REFERENCE_LINE_INCREMENT", "REFERENCE_LINE_STEP")),
             Contains("has no 'REFERENCE_LINE_INCREMENT'"));
  CHECK(error_of(kParameters, "#:LRFI\nD:reference line phi,rad\n") ==
        "road.crg: error: has no channel 'D:long section'");
  CHECK_THAT(error_of(replace(kParameters, "LONG_SECTION_V_LEFT", "LONG_SECTION_LEFT")),
             Contains("sections must be numbered 1, 2"));
  CHECK_THAT(error_of(kParameters, replace(kChannels, "section 2", "section 3")),
             Contains("sections must be numbered"));
  CHECK_THAT(error_of(kParameters + "$\n$ROAD_CRG_MODS\nSCALE_Z_GRID = 2.0\n"),
             Contains("the block '$ROAD_CRG_MODS' is not read"));
  std::ofstream("road.crg") << "0.0 1.0\n1.0 2.0\n";
  CHECK_THROWS_WITH(CrgFile::read("road.crg"), Contains("has no line '$$$$'"));
}

TEST_CASE("Data that contradict the header or are cut off are refused") {
  // Cut from 10 places to 6, the last number would be 0.03.
  CHECK(error_of(kParameters, kChannels, replace(kData, "*missing*", "0.03")) ==
        "road.crg:24:26: error: the line must have 3 fields of 10 places, got 25 places");
  CHECK(error_of(kParameters, kChannels, replace(kData, "*missing*", "0.0300000 0.0400000")) ==
        "road.crg:24:31: error: the line must have 3 fields of 10 places, got 40 places");
  // The third section lies at −1 + 2 · 0.7 = 0.4 m.
  CHECK(error_of(kParameters + "LONG_SECTION_V_INCREMENT = 0.7\n") ==
        "road.crg:11:1: error: 'LONG_SECTION_V_INCREMENT' puts section 3 at 0.4 m, but 'LONG_SECTION_V_LEFT' "
        "is 1 m");
  CHECK(error_of(kParameters + "LONG_SECTION_V_INCREMENT = 1.0\n") == "no error");
  CHECK(error_of(kParameters, kChannels, replace(kData, " 0.0120000", "     2e+09")) ==
        "road.crg:22:1: error: numbers must be within ±1e+09, got 2e+09");
}

#include "dynamics/measured/column_file.h"

#include <fstream>

#include "tests/catch.h"

using namespace sprung;
using dynamics::ColumnFile;
using dynamics::Signal;

namespace {

ColumnFile read(const std::string& text) {
  std::ofstream("signals.csv") << text;
  return ColumnFile::read("signals.csv");
}

// The columns as "name|unit name|unit".
std::string columns_of(const std::string& text) {
  std::string list;
  const ColumnFile file = read(text);
  for (const Signal& one : file.columns()) list += (list.empty() ? "" : " ") + one.name + "|" + one.unit;
  return list;
}

std::string error_of(const std::string& text) {
  try {
    const ColumnFile file = read(text);
    for (std::size_t i = 0; i < file.columns().size(); ++i) file.read_column(i);
    return "no error";
  } catch (const support::InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("Columns are separated by commas, semicolons, tabs or blanks") {
  for (const std::string separator : {",", ";", "\t", " "}) {
    CAPTURE(separator);
    const ColumnFile file =
        read("# a comment\n\ntime" + separator + "z\n0.0" + separator + "-1.5e-3\r\n  1.5" + separator +
             separator.substr(0, separator == " " ? 1 : 0) + "+2\n");
    REQUIRE(file.columns().size() == 2);
    CHECK(file.read_column(0) == std::vector<double>{0.0, 1.5});
    CHECK(file.read_column(1) == std::vector<double>{-1.5e-3, 2.0});
  }
}

TEST_CASE("Units stand beside the names or in a line of their own") {
  CHECK(columns_of("time [s],front (mm), left wheel [ kN ]\n0,1,2\n1,1,2\n") ==
        "time|s front|mm left wheel|kN");
  CHECK(columns_of("time;front\ns;mm\n0;1\n1;2\n") == "time|s front|mm");
  CHECK(columns_of("\xEF\xBB\xBF\"time\",\"front, left\"\n[s],[mm]\n0,1\n1,2\n") == "time|s front, left|mm");
  CHECK(columns_of("\"time\" [ms],\"front, left\" (kN)\n0,1\n1,2\n") == "time|ms front, left|kN");
  CHECK(columns_of("time,front\n0,1\n1,2\n") == "time| front|");
  CHECK(columns_of("time;front;grade\ns;mm;1\n0;1;2\n1;1;2\n") == "time|s front|mm grade|1");
  CHECK(columns_of("time;front;note\n1;1;x\n2;1;y\n") == "time| front| note|");  // x is no unit
  CHECK(read("time;front\ns;mm\n0;1\n1;2\n").read_column(1) == std::vector<double>{1.0, 2.0});
  CHECK(error_of("time [s],front [mm]\ns,m\n0,1\n1,2\n") ==
        "signals.csv:2:3: error: the column 'front' has the unit 'mm' in the line of names, and 'm' here");
}

TEST_CASE("Columns that are not read may hold anything") {
  const ColumnFile file = read("time,remark,z\n0,start,1\n1,\"a, b\",2\n2,,3\n");
  CHECK(file.read_column(2) == std::vector<double>{1.0, 2.0, 3.0});
  CHECK_THROWS_AS(file.read_column(1), support::InputError);
  const ColumnFile last = read("time,z,remark\n0,1,start\n1,2,\n2,3, \r\n");
  CHECK(last.read_column(1) == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(error_of("time,z,remark\n0,1,start\n1,2\n").find("the line has 2 cells, expected 3") !=
        std::string::npos);
}

TEST_CASE("The place of a cell counts comments and blank lines") {
  const support::SourceLocation place = read("time,z\n# from here on\n0,1\n\n1, 2\n").locate(1, 1);
  CHECK(place.line == 5);
  CHECK(place.column == 4);
}

TEST_CASE("Files that do not fit are refused at the line and column") {
  CHECK(error_of("") == "signals.csv: error: is empty; expected a line with the names of columns");
  CHECK(error_of("time,z\n") == "signals.csv: error: has no lines below the names of the columns");
  CHECK(error_of("time,z\n0,1\n") == "signals.csv: error: must have at least 2 lines of numbers, got 1");
  CHECK(error_of("0.0,1.0\n1.0,2.0\n") ==
        "signals.csv:1:1: error: the first line must have the names of the columns, got the number '0.0'");
  CHECK(error_of("time,z,z\n0,1,2\n1,2,3\n") == "signals.csv:1:8: error: two columns have the name 'z'");
  CHECK(error_of("time,,z\n0,1,2\n1,2,3\n") == "signals.csv:1:6: error: a column must have a name");
  CHECK(error_of("time,z\n0,1\n1\n") ==
        "signals.csv:3:1: error: the line has 1 cells, expected 2, one for each name: 'time', 'z'");
  CHECK(error_of("time,z\n0,1\n1,2,3\n") ==
        "signals.csv:3:5: error: the line has 3 cells, expected 2, one for each name: 'time', 'z'");
  CHECK(error_of("time,z\n0,1\n1,nan\n") ==
        "signals.csv:3:3: error: 'z' must be a finite number within ±1e+15, got 'nan'");
  CHECK(error_of("time,z\n0,1\n1,\n2,3\n") ==
        "signals.csv:3:3: error: 'z' must be a finite number within ±1e+15, got an empty cell");
  CHECK(error_of("time,y,z\n0,1,1\n1,,2\n") ==
        "signals.csv:3:3: error: 'y' must be a finite number within ±1e+15, got an empty cell");
  CHECK(error_of("time;z\n0;1\n1;0,5\n") ==
        "signals.csv:3:3: error: 'z' must be a finite number within ±1e+15, got '0,5', which has a decimal "
        "comma "
        "instead of a point");
  CHECK_THAT(error_of("time,z\n0,1\n1,1e300\n"), Contains("got '1e300'"));
  CHECK_THAT(error_of("time,z\n0,1\n1,0x10\n"), Contains("got '0x10'"));
  CHECK(
      error_of("time,\"z\" mm\n0,1\n1,2\n") ==
      "signals.csv:1:7: error: expected the end of the cell or a unit in brackets behind the name in quotes, "
      "got 'mm'");
  CHECK_THAT(error_of("time,\"z\"\"y\"\n0,1\n1,2\n"), Contains("behind the name in quotes, got '\"y\"'"));
  CHECK(error_of("time,z\n0,\"1\"5\n1,2\n") ==
        "signals.csv:2:4: error: expected the end of the cell behind the number in quotes, got '5'");
  CHECK_THAT(error_of("time,z\n0,\"1\n1,2\n"), Contains("signals.csv:2:4: error"));
}

TEST_CASE("Content that is not text is refused at its byte, which is not repeated") {
  CHECK(error_of(std::string("time,z\n0,1\n1,\0\n", 15)) ==
        "signals.csv:3:3: error: is no text: got the byte 0x00, as of binary data or another encoding; "
        "expected "
        "UTF-8 or ASCII");
  CHECK(error_of(std::string("\xFF\xFEt\0,\0z\0", 8)) ==
        "signals.csv:1:1: error: is no text: got the byte 0xFF, as of UTF-16; expected UTF-8 or ASCII");
  CHECK(error_of("time,\xB5m\n0,1\n1,2\n") ==
        "signals.csv:1:6: error: is no text: got the byte 0xB5, as of Latin-1 or Windows-1252; convert it by "
        "iconv -f WINDOWS-1252 -t UTF-8 OLD > NEW; expected UTF-8 or ASCII");
  CHECK(error_of("time,z [\xC2\xB5m]\n0,1\n1,2\n") == "no error");
}

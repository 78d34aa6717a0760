#include "dynamics/element_input/time_function_input.h"

#include <cmath>
#include <numbers>

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using dynamics::TimeFunction;
using dynamics::TimeFunctionUse;

namespace {

using std::numbers::pi;

TimeFunction read(const std::string& text, TimeFunctionUse use = TimeFunctionUse::kForce) {
  const support::TomlDocument document = support::TomlDocument::parse("f = " + text + "\n", "v.toml");
  dynamics::HistoryFiles histories("");
  return dynamics::read_time_function(document.root().at("f"), "N", use, histories);
}

std::string error_of(const std::string& text, TimeFunctionUse use = TimeFunctionUse::kForce) {
  return test::input_error_of([&] { read(text, use); });
}

}  // namespace

TEST_CASE("Sums and products of functions of time are read, one within the other") {
  const TimeFunction f = read(
      "{ sum = [5.0, { product = [{ harmonic = { amplitude = 20.0, frequency = 3.0 } }, { polynomial = [1.0, "
      "0.5] }, 2] }] }");
  for (const double t : {0.0, 0.21, 1.7}) {
    CHECK(f.value(t) == Approx(5.0 + 40.0 * std::sin(6.0 * pi * t) * (1.0 + 0.5 * t)).epsilon(1e-13));
  }
}

TEST_CASE("Pieces of functions of time are read; the last one goes on for ever") {
  const TimeFunction f = read(
      "{ pieces = [{ until = 0.5, function = 2.0 }, { until = 1.0, function = { table = [[0.6, 0.0], [0.8, "
      "1.0]] } }, { function = { polynomial = [0.0, 1.0] } }] }");
  CHECK(f.value(0.49) == 2.0);
  CHECK(f.value(0.5) == 0.0);
  CHECK(f.value(0.7) == Approx(0.5).epsilon(1e-13));
  CHECK(f.value(0.9) == 1.0);
  CHECK(f.value(3.0) == Approx(3.0).epsilon(1e-15));
  CHECK(read("{ pieces = [{ function = 4 }] }").is_constant());
}

TEST_CASE("Equal times in a table of a force are a jump; a motion cannot jump") {
  const std::string table = "{ table = [[0.0, 0.0], [1.0, 2.0], [1.0, 5.0]] }";
  CHECK(read(table).value(1.0) == 5.0);
  CHECK(error_of(table, TimeFunctionUse::kMotion) ==
        "v.toml:1:40: error: 'f.table.2' must ascend: 1 s comes after 1 s");
  CHECK(error_of("{ table = [[0.0, 0.0], [1.0, 2.0], [1.0, 5.0], [1.0, 7.0]] }") ==
        "v.toml:1:52: error: 'f.table.3' must ascend, and at a jump two are equal, not three: 1 s comes "
        "after 1 s");
  CHECK(error_of("{ table = [[0.0, 0.0], [1.0, 2.0], [0.9, 5.0]] }") ==
        "v.toml:1:40: error: 'f.table.2' must ascend: 0.9 s comes after 1 s");
  // The integrators join times that lie closer, and would lose a pulse between them. Those of the parts of a
  // sum may differ by rounding.
  CHECK(error_of("{ table = [[0.5, 0.0], [0.5, 1e9], [0.500000000999, 1e9], [0.500000000999, 0.0]] }") ==
        "v.toml:1:15: error: 'f.table' changes at 0.5 s and again 9.99e-10 s later, expected at least 1e-09 "
        "s; give a "
        "shorter pulse as a longer one of the same area");
  CHECK_NOTHROW(
      read("{ sum = [{ table = [[0.3, 0.0], [0.4, 1.0]] }, { table = [[0.30000000000000004, 0.0], [0.4, "
           "1.0]] }] }"));
  // The unit of the cases is N; a motion's is m or rad.
  CHECK(error_of("{ pieces = [{ until = 1.0, function = 0.0 }, { function = 0.5 }] }",
                 TimeFunctionUse::kMotion) ==
        "v.toml:1:5: error: 'f' must not jump, as it moves bodies: its value is 0 N before t = 1 s and 0.5 N "
        "after");
  const std::string bend =
      "{ pieces = [{ until = 1.0, function = 0.0 }, { function = { polynomial = [-2.0, 2.0] } }] }";
  CHECK(
      error_of(bend, TimeFunctionUse::kMotion) ==
      "v.toml:1:5: error: 'f' must not jump, as it moves bodies: its rate is 0 N/s before t = 1 s and 2 N/s "
      "after");
  CHECK(read(bend).value(1.5) == Approx(1.0));
  // (t − 1)² from t = 1 s on: only the acceleration jumps.
  CHECK(
      read("{ pieces = [{ until = 1.0, function = 0.0 }, { function = { polynomial = [1.0, -2.0, 1.0] } }] }",
           TimeFunctionUse::kMotion)
          .acceleration(1.5) == Approx(2.0));
}

TEST_CASE("Impossible sums, products and pieces are refused") {
  CHECK(error_of("{ sum = [] }") == "v.toml:1:13: error: 'f.sum' must have at least one function of time");
  CHECK(error_of("{ product = [2.0, \"x\"] }") ==
        "v.toml:1:23: error: 'f.product.1' must be a number or a function of time");
  CHECK(error_of("{ sum = [2.0, { harmony = 1 }] }").find("unknown key 'harmony' in 'f.sum.1'") !=
        std::string::npos);
  CHECK(error_of("{ pieces = [{ function = 0.0 }, { function = 1.0 }] }") ==
        "v.toml:1:17: error: missing key 'until' in 'f.pieces.0'");
  CHECK(error_of(
            "{ pieces = [{ until = 1.0, function = 0.0 }, { until = 0.5, function = 1.0 }, { function = 2 }] "
            "}") ==
        "v.toml:1:60: error: 'f.pieces.1.until' must come after that of the piece before, 1 s, got 0.5 s");
  CHECK(error_of("{ pieces = [{ until = 1.0, function = 0.0 }, { until = 2.0, function = 1.0 }] }") ==
        "v.toml:1:60: error: 'f.pieces.1.until' must be left out of the last piece, which goes on for ever");
  CHECK(error_of("{}") ==
        "v.toml:1:5: error: 'f' must have one of 'polynomial', 'harmonic', 'table', 'history', 'step', "
        "'sum', 'product' "
        "and 'pieces'");
}

TEST_CASE("Products that grow beyond all measure are refused") {
  std::string waves, powers;
  long frequency = 1;  // powers of 3: no sum or difference of some of them is that of others
  for (int i = 1; i <= 12; ++i, frequency *= 3) {
    const std::string separator = i > 1 ? ", " : "";
    waves += separator + "{ harmonic = { amplitude = 1, frequency = " + std::to_string(frequency) + " } }";
    powers += separator + "{ polynomial = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1] }";
  }
  CHECK(error_of("{ product = [" + waves + "] }")
            .find("'f.product' has 1024 oscillations when it is multiplied out") != std::string::npos);
  CHECK(error_of("{ product = [" + powers + "] }") ==
        "v.toml:1:17: error: 'f.product' has polynomials of degree 110 when it is multiplied out, must have "
        "at most 100");
}

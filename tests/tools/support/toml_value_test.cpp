#include <limits>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"
#include "tools/support/toml/toml.h"

using namespace sprung::support;

namespace {

// The error of a conversion of `x` in a document `[b]`, `x = text`: the value stands at 2:5.
template <typename Conversion>
std::string conversion_error(const std::string& text, Conversion&& conversion) {
  const TomlDocument document = TomlDocument::parse("[b]\nx = " + text + "\n", "v.toml");
  const TomlValue value = document.root().at("b").table().at("x");
  const std::string message = error_message<InputError>([&] { conversion(value); });
  const std::string expected_start = "v.toml:2:5: error: 'b.x' ";
  REQUIRE_THAT(message, Catch::Matchers::StartsWith(expected_start));
  return message.substr(expected_start.size());
}

std::string number_error(const std::string& text, const Quantity& quantity) {
  return conversion_error(text, [&](const TomlValue& value) { return value.number(quantity); });
}

constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();

}  // namespace

TEST_CASE("values are converted to what they are") {
  const TomlDocument document = TomlDocument::parse(
      "real = -2.5\nwhole = 7\nflag = true\nword = \"adams\"\nlist = [1, 2.5, -3]\nnone = []\n[sub]\n",
      "v.toml");
  const TomlTable root = document.root();
  CHECK(root.at("real").number(any("m")) == -2.5);
  CHECK(root.at("whole").number(positive("m")) == 7.0);
  CHECK(root.at("whole").integer(0, 7) == 7);
  CHECK(root.at("flag").boolean());
  CHECK(root.at("word").string() == "adams");
  CHECK(root.at("list").numbers(any("m")) == std::vector{1.0, 2.5, -3.0});
  CHECK(root.at("list").numbers(any("m"), 3) == std::vector{1.0, 2.5, -3.0});
  CHECK(root.at("list").items().size() == 3);
  CHECK(root.at("none").numbers(any("m")).empty());
  CHECK(root.at("sub").table().key() == "sub");
  CHECK(root.at("word").one_of(std::vector<std::string>{"bdf", "adams"}) == "adams");
}

TEST_CASE("values tell their type") {
  const TomlDocument document =
      TomlDocument::parse("real = 1.0\nwhole = 1\nword = \"\"\nlist = []\nflag = false\n[sub]\n", "v.toml");
  std::string found;
  for (const auto& [name, value] : document.root().entries()) {
    found += name + ":" + (value.is_number() ? "n" : "") + (value.is_integer() ? "i" : "") +
             (value.is_string() ? "s" : "") + (value.is_array() ? "a" : "") + (value.is_table() ? "t" : "") +
             " ";
  }
  CHECK(found == "real:n whole:ni word:s list:a flag: sub:t ");
}

TEST_CASE("bounds of a number belong to it or not as they say") {
  const TomlDocument document = TomlDocument::parse("zero = 0\none = 1\n", "v.toml");
  const TomlTable root = document.root();
  CHECK(root.number("zero", non_negative("m")) == 0.0);
  CHECK(root.number("one", {.unit = "m", .at_most = 1.0}) == 1.0);
  CHECK(number_error("0", positive("kg")) == "must be > 0 kg, got 0");
}

TEST_CASE("a number out of range is refused with the range and its unit") {
  CHECK(number_error("-3", positive("kg")) == "must be > 0 kg, got -3");
  CHECK(number_error("-1e-3", non_negative("N·s/m")) == "must be ≥ 0 N·s/m, got -0.001");
  CHECK(number_error("1.5", {.unit = "", .at_least = 0.0, .at_most = 1.0}) == "must be ≥ 0 and ≤ 1, got 1.5");
  CHECK(number_error("2", {.unit = "m", .above = 0.0, .at_most = 1.0}) == "must be > 0 and ≤ 1 m, got 2");
}

TEST_CASE("a number whose products with others would overflow is refused, whatever its range") {
  CHECK(number_error("1e300", any("N/m")) == "must be ≤ 1e+30 N/m, got 1e+300");
  CHECK(number_error("-1e31", any("")) == "must be ≥ -1e+30, got -1e+31");
  CHECK(number_error("1e-300", positive("kg")) == "must be ≥ 1e-50 kg, got 1e-300");
  for (const std::string unit : {"m", "rad", "s", "Hz", "m/s", "rad/s"}) {
    CHECK(number_error("2e9", positive(unit)) == "must be ≤ 1000000000 " + unit + ", got 2000000000");
    CHECK(number_error("-2000000000", any(unit)) == "must be ≥ -1000000000 " + unit + ", got -2000000000");
  }
  const TomlDocument document = TomlDocument::parse("large = -1e30\nfar = 1e9\nsmall = 1e-300\n", "v.toml");
  CHECK(document.root().number("large", any("N")) == -1e30);
  CHECK(document.root().number("far", positive("m")) == 1e9);
  CHECK(document.root().number("small", non_negative("kg")) == 1e-300);
}

TEST_CASE("a value that is no number is refused with the unit and its type") {
  CHECK(number_error("\"heavy\"", positive("kg")) == "must be a number [kg], got a string \"heavy\"");
  CHECK(number_error("true", positive("")) == "must be a number, got a boolean true");
  CHECK(number_error("[1, 2]", any("m")) == "must be a number [m], got an array of 2");
  CHECK(number_error("{}", any("m")) == "must be a number [m], got a table");
  CHECK(number_error("\"" + std::string(39, 'x') + "äy\"", any("m")) ==
        "must be a number [m], got a string \"" + std::string(39, 'x') + "…\"");
}

TEST_CASE("numbers that are not finite are refused for any range") {
  CHECK(number_error("inf", positive("kg")) == "must be a finite number [kg], got inf");
  CHECK(number_error("-inf", any("")) == "must be a finite number, got -inf");
  CHECK(number_error("nan", any("m")) == "must be a finite number [m], got nan");
}

TEST_CASE("a value that is no integer of the range is refused") {
  const auto error = [](const std::string& text, std::int64_t minimum, std::int64_t maximum) {
    return conversion_error(text, [=](const TomlValue& value) { return value.integer(minimum, maximum); });
  };
  CHECK(error("12", 1, 10) == "must be an integer from 1 to 10, got 12");
  CHECK(error("0", 1, kHighest) == "must be an integer ≥ 1, got 0");
  CHECK(error("9", kLowest, 8) == "must be an integer ≤ 8, got 9");
  CHECK(error("3.0", 1, 10) == "must be an integer from 1 to 10, got a number 3.0");
  CHECK(error("\"3\"", kLowest, kHighest) == "must be an integer, got a string \"3\"");
}

TEST_CASE("values of other types are refused with the expected type") {
  CHECK(conversion_error("1", [](const TomlValue& v) { v.boolean(); }) ==
        "must be true or false, got an integer 1");
  CHECK(conversion_error("2.5", [](const TomlValue& v) { v.string(); }) ==
        "must be a string, got a number 2.5");
  CHECK(conversion_error("1", [](const TomlValue& v) { v.items(); }) == "must be an array, got an integer 1");
  CHECK(conversion_error("1", [](const TomlValue& v) { v.table(); }) == "must be a table, got an integer 1");
}

TEST_CASE("an array of numbers is refused as a whole or at the wrong element") {
  const auto numbers = [](const TomlValue& v) { v.numbers(any("m")); };
  const auto three = [](const TomlValue& v) { v.numbers(any("m"), 3); };
  CHECK(conversion_error("1", numbers) == "must be an array of numbers [m], got an integer 1");
  CHECK(conversion_error("[1, 2]", three) == "must be an array of 3 numbers [m], got an array of 2");
  const TomlDocument document = TomlDocument::parse("p = [1, \"two\"]\n", "v.toml");
  CHECK(error_message<InputError>([&] { document.root().at("p").numbers(any("m")); }) ==
        "v.toml:1:9: error: 'p.1' must be a number [m], got a string \"two\"");
}

TEST_CASE("a word that is not in the list is refused with the list and the nearest one") {
  const std::vector<std::string> words = {"flat", "half-sine"};
  const auto word = [&](const TomlValue& v) { v.one_of(words); };
  CHECK(conversion_error("\"halfsine\"", word) ==
        "must be one of \"flat\", \"half-sine\"; got a string \"halfsine\" (did you mean 'half-sine'?)");
  CHECK(conversion_error("\"mountains\"", word) ==
        "must be one of \"flat\", \"half-sine\"; got a string \"mountains\"");
  CHECK(conversion_error("3", word) == "must be one of \"flat\", \"half-sine\"; got an integer 3");
}

TEST_CASE("an error of the program's own is thrown at the value") {
  CHECK(conversion_error("3", [](const TomlValue& v) { throw v.error("names no body"); }) == "names no body");
}

#include "dynamics/input/output_input.h"

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using dynamics::StoredGroup;
using test::input_error_of;
using Which = dynamics::StorageRequest::Which;

namespace {

dynamics::OutputSettings read(const std::string& text) {
  const support::TomlDocument document = support::TomlDocument::parse(text, "run.toml");
  return dynamics::read_output(document.root(), 1e-3);
}

std::string error_of(const std::string& text) {
  return input_error_of([&] { read(text); });
}

}  // namespace

TEST_CASE("Histories are chosen by groups, each with a step of its own") {
  const dynamics::OutputSettings settings = read(R"(
points = ["frame.seat"]
size = 50
precision = "single"
store = { points = "reported", joints = "none", forces = ["tyre"], bodies = "all" }
step = { recovery = 0.01, joints = 1e-3 })");
  CHECK(settings.points.size() == 1);
  CHECK(settings.size == 50.0);
  CHECK(settings.precision == dynamics::StoredPrecision::kSingle);
  CHECK(settings.of(StoredGroup::kPoints).which == Which::kReported);
  CHECK(settings.of(StoredGroup::kJoints).which == Which::kNone);
  CHECK(settings.of(StoredGroup::kForces).which == Which::kListed);
  CHECK(settings.of(StoredGroup::kForces).names == std::vector<std::string>{"tyre"});
  CHECK(settings.of(StoredGroup::kBodies).which == Which::kAll);
  CHECK(settings.of(StoredGroup::kRecovery).which == Which::kBySize);
  CHECK(settings.of(StoredGroup::kRecovery).every == 10);
  CHECK(settings.of(StoredGroup::kJoints).every == 1);
  CHECK_FALSE(settings.of(StoredGroup::kPoints).every.has_value());
}

TEST_CASE("Without [output] the size of 20 MB chooses") {
  const dynamics::OutputSettings settings;
  CHECK(settings.size == 20.0);
  CHECK_FALSE(settings.precision.has_value());
  for (const dynamics::StorageRequest& group : settings.groups) CHECK(group.which == Which::kBySize);
}

TEST_CASE("Wrong choices of histories are refused with their place") {
  CHECK(
      error_of("step = { recovery = 0.0015 }") ==
      "run.toml:1:21: error: 'step.recovery' must be a multiple of the output_step of 0.001 s, got 0.0015 s");
  CHECK(
      error_of("step = { recovery = 1e-4 }") ==
      "run.toml:1:21: error: 'step.recovery' must be a multiple of the output_step of 0.001 s, got 0.0001 s");
  CHECK(error_of("store = { joints = \"reported\" }") ==
        "run.toml:1:20: error: 'store.joints' must be one of \"all\", \"none\"; got a string \"reported\"");
  CHECK(error_of("store = { joint = \"all\" }") ==
        "run.toml:1:11: error: unknown key 'joint' in 'store' (did you mean 'joints'?)");
  CHECK(error_of("size = 0") == "run.toml:1:8: error: 'size' must be > 0 MB, got 0");
}

TEST_CASE("A list of histories names what the vehicle has") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  CHECK(input_error_of(
            [&] { check_stored_names(read("store = { bodies = [\"frame\", \"frane\"] }"), cart); }) ==
        "run.toml:1:30: error: 'output.store.bodies' names 'frane', which the vehicle does not have (did you "
        "mean "
        "'frame'?)");
  check_stored_names(read("store = { points = [\"frame.seat\"], bodies = [\"arm\"] }"), cart);
}

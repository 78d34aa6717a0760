#include "tools/support/errors/input_error.h"

#include <string>
#include <vector>

#include "tests/catch.h"

using sprung::support::InputError;
using sprung::support::nearest_name_hint;

TEST_CASE("an input error gives its location as far as it is known") {
  CHECK(std::string(InputError({"a.toml", 12, 8}, "must be > 0 kg").what()) ==
        "a.toml:12:8: error: must be > 0 kg");
  CHECK(std::string(InputError({"a.toml", 12}, "is wrong").what()) == "a.toml:12: error: is wrong");
  CHECK(std::string(InputError({"a.toml"}, "is wrong").what()) == "a.toml: error: is wrong");
  CHECK(std::string(InputError({}, "is wrong").what()) == "error: is wrong");
}

TEST_CASE("a name's hint is the nearest candidate, or nothing where none is near") {
  const std::vector<std::string> candidates = {"mass", "inertia", "position"};
  CHECK(nearest_name_hint("masss", candidates) == " (did you mean 'mass'?)");
  CHECK(nearest_name_hint("interia", candidates) == " (did you mean 'inertia'?)");
  CHECK(nearest_name_hint("colour", candidates).empty());
  CHECK(nearest_name_hint("mass", {}).empty());
  const std::vector<std::string> classes = {"A", "B", "C"};
  CHECK(nearest_name_hint("Z", classes).empty());  // no letter in common
  CHECK(nearest_name_hint("c", classes) == " (did you mean 'C'?)");
}

#include <string>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"
#include "tools/support/toml/toml.h"

using namespace sprung::support;

namespace {

const char* const kText =
    "speed = 3.0\n"
    "[bodies.chassis]\n"
    "masss = 11950\n"
    "inertia = 58300\n";

}  // namespace

TEST_CASE("keys are found or take their default") {
  const TomlDocument document =
      TomlDocument::parse("a = 1.5\nb = 2\nc = true\nd = \"word\"\n[e]\n", "v.toml");
  const TomlTable root = document.root();
  CHECK(root.has("a"));
  CHECK_FALSE(root.has("z"));
  CHECK_FALSE(root.find("z").has_value());
  CHECK(root.number("a", any("m")) == 1.5);
  CHECK(root.number_or("a", 9.0, any("m")) == 1.5);
  CHECK(root.number_or("z", 9.0, any("m")) == 9.0);
  CHECK(root.integer_or("b", 9, 0, 10) == 2);
  CHECK(root.integer_or("z", 9, 0, 10) == 9);
  CHECK(root.boolean_or("c", false));
  CHECK(root.boolean_or("z", true));
  CHECK(root.string("d") == "word");
  CHECK(root.string_or("d", "other") == "word");
  CHECK(root.string_or("z", "other") == "other");
  CHECK(root.find_table("e").has_value());
  CHECK_FALSE(root.find_table("z").has_value());
}

TEST_CASE("a given value is checked, with or without a default") {
  const TomlDocument document = TomlDocument::parse("a = -1\n", "v.toml");
  const TomlTable root = document.root();
  CHECK(error_message<InputError>([&] { root.number_or("a", 9.0, positive("m")); }) ==
        "v.toml:1:5: error: 'a' must be > 0 m, got -1");
  CHECK(error_message<InputError>([&] { root.find_table("a"); }) ==
        "v.toml:1:5: error: 'a' must be a table, got an integer -1");
}

TEST_CASE("a missing key is named with its table") {
  const TomlDocument document = TomlDocument::parse(kText, "v.toml");
  const TomlTable chassis = document.root().at("bodies").table().at("chassis").table();
  CHECK(error_message<InputError>([&] { chassis.number("mass", positive("kg")); }) ==
        "v.toml:2:1: error: missing key 'mass' in 'bodies.chassis'; is 'masss' meant to be it?");
  CHECK(error_message<InputError>([&] { document.root().at("duration"); }) ==
        "v.toml: error: missing key 'duration'");
}

TEST_CASE("a text with the character NUL is refused at its location") {
  CHECK(error_message<InputError>([] { TomlDocument::parse("name = \"a\\u0000b\"\n", "v.toml"); }) ==
        "v.toml:1:8: error: 'name' contains the character NUL");
}

TEST_CASE("for a missing key the nearest misspelt one is named") {
  const TomlDocument document = TomlDocument::parse("mas = 3\nb = 1\n", "v.toml");
  CHECK(error_message<InputError>([&] { document.root().at("mass"); }) ==
        "v.toml: error: missing key 'mass'; is 'mas' meant to be it?");
  CHECK(error_message<InputError>([&] { document.root().at("a"); }) == "v.toml: error: missing key 'a'");
}

TEST_CASE("an unknown key is refused at its location, with the nearest known one") {
  const TomlDocument document = TomlDocument::parse(kText, "v.toml");
  const TomlTable chassis = document.root().at("bodies").table().at("chassis").table();
  chassis.number_or("mass", 1.0, positive("kg"));
  chassis.number("inertia", positive("kg·m²"));
  CHECK(error_message<InputError>([&] { chassis.reject_unknown_keys(); }) ==
        "v.toml:3:1: error: unknown key 'masss' in 'bodies.chassis' (did you mean 'mass'?)");
}

TEST_CASE("a key unlike all others is refused with all that are known") {
  const TomlDocument document = TomlDocument::parse(kText, "v.toml");
  const TomlTable root = document.root();
  root.at("speed");
  CHECK(error_message<InputError>([&] { root.reject_unknown_keys(); }) ==
        "v.toml:2:2: error: unknown key 'bodies' (known keys: speed)");
  const TomlTable empty = root.at("bodies").table();
  CHECK(error_message<InputError>([&] { empty.reject_unknown_keys(); }) ==
        "v.toml:2:9: error: unknown key 'chassis' in 'bodies'");
}

TEST_CASE("a table whose keys were all read has no unknown one") {
  const TomlDocument document = TomlDocument::parse("a = 1\nb = 2\n", "v.toml");
  const TomlTable root = document.root();
  root.has("a");
  root.find("b");
  root.find("b");
  root.find("c");
  root.reject_unknown_keys();
  REQUIRE(root.asked_keys().size() == 3);
  CHECK(root.asked_keys()[2] == "c");

  const TomlDocument other = TomlDocument::parse("a = 1\nb = 2\n", "v.toml");
  CHECK(other.root().entries().size() == 2);
  other.root().reject_unknown_keys();
}

TEST_CASE("an error of the program's own is thrown at the table") {
  const TomlDocument document = TomlDocument::parse(kText, "v.toml");
  const TomlTable root = document.root();
  CHECK(std::string(root.error("describes no vehicle").what()) == "v.toml: error: describes no vehicle");
  CHECK(std::string(root.at("bodies").table().at("chassis").table().error("has no shape").what()) ==
        "v.toml:2:1: error: 'bodies.chassis' has no shape");
}

#include <string>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"
#include "tools/support/toml/toml.h"

using namespace sprung::support;

namespace {

TomlDocument make_document() {
  return TomlDocument::parse(
      "speed = 3.0\n"
      "[modes]\n"
      "chassis = 2\n"
      "[road]\n"
      "shape = \"half-sine\"\n"
      "points = [[0, 0.1], [1, 0.2]]\n"
      "[[forces]]\n"
      "name = \"front\"\n"
      "stiffness = 5.0\n"
      "[[forces]]\n"
      "name = \"rear\"\n"
      "stiffness = 6.0\n",
      "run.toml");
}

TomlDocument overridden(std::string_view assignment) {
  TomlDocument document = make_document();
  document.set(assignment, "--set 1");
  return document;
}

std::string override_error(std::string_view assignment) {
  return error_message<InputError>([&] { overridden(assignment); });
}

}  // namespace

TEST_CASE("an override replaces a value of any type") {
  CHECK(overridden("speed=7.5").root().number("speed", any("m/s")) == 7.5);
  CHECK(overridden(" modes . chassis = 0 ").root().at("modes").table().at("chassis").integer(0, 9) == 0);
  CHECK(overridden("modes.chassis=[1, 3]").root().at("modes").table().at("chassis").items().size() == 2);
  CHECK(overridden("modes.chassis=true").root().at("modes").table().at("chassis").boolean());
  CHECK(overridden("modes.chassis=\"a=b\"").root().at("modes").table().string("chassis") == "a=b");
}

TEST_CASE("a bare word is a string") {
  CHECK(overridden("road.shape=flat").root().at("road").table().string("shape") == "flat");
  CHECK(overridden("vehicle=models/truck/vehicle.toml").root().string("vehicle") ==
        "models/truck/vehicle.toml");
}

TEST_CASE("an override creates the tables of its path, and its key comes last") {
  const TomlDocument document = overridden("modal_damping.\"front arm\".first=0.01");
  const TomlValue value = document.root().at("modal_damping").table().at("front arm").table().at("first");
  CHECK(value.number(any("")) == 0.01);
  CHECK(value.key() == "modal_damping.\"front arm\".first");
  CHECK(document.root().entries().back().first == "modal_damping");
}

TEST_CASE("a table given by an override replaces the whole table") {
  const TomlDocument document = overridden("road={shape=\"bump\", height=0.2}");
  const TomlTable road = document.root().at("road").table();
  CHECK(road.entries().size() == 2);
  CHECK(road.at("height").key() == "road.height");
}

TEST_CASE("an override reaches into an array by position or name") {
  const auto stiffness = [](const TomlDocument& document, std::size_t i) {
    return document.root().at("forces").items()[i].table().number("stiffness", any("N/m"));
  };
  const TomlDocument by_position = overridden("forces.0.stiffness=7");
  CHECK(stiffness(by_position, 0) == 7.0);
  CHECK(stiffness(by_position, 1) == 6.0);
  const TomlDocument by_name = overridden("forces.rear.stiffness=8");
  CHECK(stiffness(by_name, 0) == 5.0);
  CHECK(stiffness(by_name, 1) == 8.0);
  CHECK(overridden("road.points.1.0=4")
            .root()
            .at("road")
            .table()
            .at("points")
            .items()[1]
            .numbers(any("m"), 2)[0] == 4.0);
}

TEST_CASE("other values stay as they were, and so does the text") {
  const TomlDocument document = overridden("modes.chassis=4");
  CHECK(document.root().number("speed", any("m/s")) == 3.0);
  CHECK(document.root().at("speed").location().line == 1);
  CHECK(document.text() == make_document().text());
}

TEST_CASE("an override with a bad value is refused with the override's name") {
  const TomlDocument speed = overridden("speed=-1");
  CHECK(error_message<InputError>([&] { speed.root().number("speed", positive("m/s")); }) ==
        "--set 1: error: 'speed' must be > 0 m/s, got -1");
  const TomlDocument words = overridden("speed=3 m/s");
  CHECK(error_message<InputError>([&] { words.root().number("speed", any("m/s")); }) ==
        "--set 1: error: 'speed' must be a number [m/s], got a string \"3 m/s\"");
  const TomlDocument nested = overridden("road.points=[[0, inf]]");
  CHECK(error_message<InputError>([&] {
          nested.root().at("road").table().at("points").items()[0].numbers(any("m"));
        }) == "--set 1: error: 'road.points.0.1' must be a finite number [m], got inf");
  const TomlDocument unknown = overridden("road.heigth=0.1");
  const TomlTable road = unknown.root().at("road").table();
  for (const char* key : {"shape", "points", "height"}) road.has(key);
  CHECK(error_message<InputError>([&] { road.reject_unknown_keys(); }) ==
        "--set 1: error: unknown key 'heigth' in 'road' (did you mean 'height'?)");
}

TEST_CASE("an override that is no assignment is refused") {
  const std::string text = GENERATE(as<std::string>{}, "speed", "=3", "speed=", ".speed=3",
                                    "road..shape=flat", "\"speed=3", "a\"b\"=3", "\"a\"b=3", "");
  CHECK(override_error(text) == "--set 1: error: '" + text + "' is not of the form key.path=value");
}

TEST_CASE("a value that begins like TOML but is not is refused") {
  CHECK(override_error("modes.chassis=[1, 2") == "--set 1: error: '[1, 2' is not a TOML value");
  CHECK(override_error("road.shape=\"flat") == "--set 1: error: '\"flat' is not a TOML value");
  CHECK(override_error("speed=1\nmodes=2") == "--set 1: error: '1\nmodes=2' is not a TOML value");
}

TEST_CASE("a number that double precision or 64 bits cannot hold is called so") {
  CHECK(override_error("speed=1e400") ==
        "--set 1: error: 1e400 is too large for double precision, whose largest number is 1.8e+308");
  CHECK(override_error("speed=-1_0.5E+999") ==
        "--set 1: error: -1_0.5E+999 is too large for double precision, whose largest number is 1.8e+308");
  CHECK(override_error("speed=99999999999999999999") ==
        "--set 1: error: 99999999999999999999 is too large for an integer, which has 64 bits; a number is "
        "written as 1e+20");
  CHECK_NOTHROW(overridden("name=1e400x"));
}

TEST_CASE("a path that runs through a plain value is refused") {
  CHECK(override_error("speed.x=1") ==
        "--set 1: error: 'speed' is a number 3.0, not a table: it has no key 'x'");
  CHECK(override_error("road.points.0.1.z=1") ==
        "--set 1: error: 'road.points.0.1' is a number 0.1, not a table: it has no key 'z'");
}

TEST_CASE("a path to no element of an array is refused") {
  CHECK(override_error("forces.2.stiffness=1") ==
        "--set 1: error: 'forces' is an array of 2, counted from 0: it has no 2");
  CHECK(override_error("forces.raer.stiffness=1") ==
        "--set 1: error: 'forces' has no element named 'raer' (did you mean 'rear'?)");
  CHECK(override_error("forces.\"0\".stiffness=1") == "--set 1: error: 'forces' has no element named '0'");
  TomlDocument document = overridden("forces.front.name=rear");
  CHECK(error_message<InputError>([&] { document.set("forces.rear.stiffness=1", "--set 2"); }) ==
        "--set 2: error: 'forces' has several elements named 'rear'");
}

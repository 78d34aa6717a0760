#include <string>
#include <utility>

#include "tests/catch.h"
#include "tests/tools/support/error_message.h"
#include "tests/tools/support/temporary_folder.h"
#include "tools/support/toml/toml.h"

using namespace sprung::support;

namespace {

std::string parse_error(const std::string& text) {
  return error_message<InputError>([&] { TomlDocument::parse(text, "v.toml"); });
}

std::string place(const SourceLocation& location) {
  return location.path + ":" + std::to_string(location.line) + ":" + std::to_string(location.column);
}

}  // namespace

TEST_CASE("every value knows its location and full key") {
  const TomlDocument document = TomlDocument::parse(
      "# truck\n"
      "speed = 3.0\n"
      "\n"
      "[bodies.chassis]\n"
      "mass = 11950\n"
      "  \"long name\" = { x = [1, 2.5] }\n"
      "[[forces]]\n"
      "kind = \"spring\"\n"
      "[[forces]]\n"
      "kind = \"damper\"\n",
      "v.toml");
  const TomlTable root = document.root();
  CHECK(place(root.location()) == "v.toml:0:0");
  CHECK(root.key().empty());
  CHECK(place(root.at("speed").location()) == "v.toml:2:9");
  CHECK(root.at("speed").key() == "speed");

  const TomlTable chassis = root.at("bodies").table().at("chassis").table();
  CHECK(place(chassis.location()) == "v.toml:4:1");
  CHECK(chassis.key() == "bodies.chassis");
  CHECK(place(chassis.at("mass").location()) == "v.toml:5:8");
  const TomlValue x = chassis.at("long name").table().at("x");
  CHECK(x.key() == "bodies.chassis.\"long name\".x");
  CHECK(x.items()[1].key() == "bodies.chassis.\"long name\".x.1");
  CHECK(place(x.items()[1].location()) == "v.toml:6:27");

  const TomlValue kind = root.at("forces").items()[1].table().at("kind");
  CHECK(kind.key() == "forces.1.kind");
  CHECK(place(kind.location()) == "v.toml:10:8");
}

TEST_CASE("elements of arrays go by their names, without one by their positions") {
  TomlDocument document = TomlDocument::parse(
      "[[forces]]\nname = \"seat_air\"\nrate = 1\n[[forces]]\nrate = 2\n[[forces]]\nname = \"left "
      "one\"\nlaw.table = [[1, 2]]\n",
      "v.toml");
  const std::vector<TomlValue> forces = document.root().at("forces").items();
  CHECK(forces[0].table().at("rate").key() == "forces.seat_air.rate");
  CHECK(forces[1].table().at("rate").key() == "forces.1.rate");
  const TomlTable law = forces[2].table().at("law").table();
  CHECK(law.at("table").items()[0].items()[1].key() == "forces.\"left one\".law.table.0.1");
  document.set("forces=[{name=\"damper\", rate=3}]", "--set 1");
  CHECK(document.root().at("forces").items()[0].table().at("rate").key() == "forces.damper.rate");
}

TEST_CASE("a table's entries come in the order of the file") {
  const TomlDocument document = TomlDocument::parse(
      "[joints.rear]\nb = 1\na = 2\n[bodies.z]\n[bodies.a]\n[joints.front]\n[bodies.m]\n[a]\nz.y = 1\nb = {d "
      "= 1, c = 2}\n",
      "v.toml");
  const auto names = [](const TomlTable& table) {
    std::string text;
    for (const auto& [name, value] : table.entries()) text += name + " ";
    return text;
  };
  const TomlTable root = document.root();
  CHECK(names(root) == "joints bodies a ");
  CHECK(names(root.at("joints").table()) == "rear front ");
  CHECK(names(root.at("joints").table().at("rear").table()) == "b a ");
  CHECK(names(root.at("bodies").table()) == "z a m ");
  CHECK(names(root.at("a").table()) == "z b ");
  CHECK(names(root.at("a").table().at("b").table()) == "d c ");
}

TEST_CASE("a document is read from a file, and keeps its text") {
  const TemporaryFolder folder;
  const std::string text = "\xEF\xBB\xBF# with a byte-order mark\r\nmass = 5\r\nname = \"träger\"\r\n";
  write_bytes(folder / "v.toml", text);
  TomlDocument document = TomlDocument::read(folder / "v.toml");
  CHECK(document.text() == text);
  CHECK(document.name() == (folder / "v.toml").string());
  CHECK(document.root().number("mass", any("kg")) == 5.0);
  CHECK(document.root().string("name") == "träger");
  CHECK(place(document.root().at("mass").location()) == (folder / "v.toml").string() + ":2:8");
}

TEST_CASE("views survive a move of their document") {
  TomlDocument first = TomlDocument::parse("mass = 5", "v.toml");
  const TomlTable root = first.root();
  const TomlDocument second = std::move(first);
  CHECK(root.number("mass", any("kg")) == 5.0);
}

TEST_CASE("a file that cannot be read is named") {
  const TemporaryFolder folder;
  CHECK(error_message<InputError>([&] { TomlDocument::read(folder / "none.toml"); }) ==
        (folder / "none.toml").string() + ": error: cannot be read: No such file or directory");
}

TEST_CASE("a text that is not TOML is refused at the fault") {
  // The places are those of the offending characters; the words after them are the parsing library's.
  CHECK_THAT(parse_error("a = 1\nb = = 2\n"),
             Catch::Matchers::StartsWith("v.toml:2:5: error: is not TOML: "));
  CHECK_THAT(parse_error("a = 1\na = 2\n"), Catch::Matchers::StartsWith("v.toml:2:"));
  CHECK_THAT(parse_error("a = 1\na = 2\n"), Contains("error: is not TOML: "));
  CHECK_THAT(parse_error("a = [1, 2\n"), Contains("error: is not TOML: "));
  CHECK_THAT(parse_error("[=]\n"), Contains("v.toml:1:2: error: is not TOML: "));  // found by toml_fuzz
  CHECK_THAT(parse_error("a = 1\n\u00f6 = 2\n"), Contains("v.toml:2:1: error: is not TOML: "));  // likewise
  CHECK_THAT(parse_error("a = \"\xFF\"\n"), Catch::Matchers::StartsWith("v.toml:1:"));
  CHECK_THAT(parse_error("a = 99999999999999999999\n"),
             Catch::Matchers::StartsWith("v.toml:1:") &&
                 Catch::Matchers::EndsWith(
                     "error: 99999999999999999999 is too large for an integer, which has 64 bits; a number "
                     "is written as 1e+20"));
  CHECK_THAT(parse_error("a = 1\nb = [1e400]\n"),
             Catch::Matchers::StartsWith("v.toml:2:") &&
                 Catch::Matchers::EndsWith(
                     "error: 1e400 is too large for double precision, whose largest number is 1.8e+308"));
}

// Each part would take some of the stack.
TEST_CASE("keys of many parts are refused, and what only has many points is none") {
  const auto repeat = [](const std::string& part, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += part;
    return text;
  };
  const std::string expected = "error: a key of more than 256 parts";
  CHECK(parse_error("x = 1\n  " + repeat("a.", 20000) + "b = 1\n") == "v.toml:2:3: " + expected);
  CHECK(parse_error(std::string("[") + repeat("\"a.a\" . ", 300) + "b]\n") == "v.toml:1:2: " + expected);
  CHECK(parse_error("x = {" + repeat("'a'.", 256) + "b = 1}\n") == "v.toml:1:6: " + expected);
  const std::string deep = repeat("a.", 300) + "b = 1";
  for (const char* value :
       {R"("\"")", R"("\\")", R"('\')", R"("a # b")", R"('''it's''')", R"(""" "a" \""" ''""""")"}) {
    INFO(value);
    CHECK(parse_error("x = { y = " + std::string(value) + ", " + deep + "}\n") ==
          "v.toml:1:" + std::to_string(13 + std::string(value).size()) + ": " + expected);
    CHECK_NOTHROW(TomlDocument::parse("x = " + std::string(value) + "\n", "v.toml"));
  }
  CHECK_NOTHROW(TomlDocument::parse(repeat("a.", 255) + "b = 1\n", "v.toml"));
  CHECK_NOTHROW(TomlDocument::parse(
      "# " + repeat(".", 999) + "\nx = [" + repeat("1.5, ", 999) + "2]\ny = \"" + repeat(".", 999) + "\"\n",
      "v.toml"));
}

TEST_CASE("dates and times are refused") {
  CHECK(parse_error("[run]\nstart = 1983-06-01\n") ==
        "v.toml:2:9: error: 'run.start' is a date or time, which no key takes");
  CHECK(parse_error("a = [07:32:00]\n") == "v.toml:1:6: error: 'a.0' is a date or time, which no key takes");
  CHECK(parse_error("a = 1979-05-27T07:32:00Z\n") ==
        "v.toml:1:5: error: 'a' is a date or time, which no key takes");
}

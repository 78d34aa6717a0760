// dynamics/models/README.md, the reference of all input keys, against the keys that the readers ask for, and
// its examples against the readers.
#include <fmt/format.h>

#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "dynamics/input/run.h"
#include "dynamics/input/vehicle.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"
#include "tests/dynamics/input/reference.h"
#include "tools/support/errors/input_error.h"

using namespace sprung;

namespace {

using test::Keys;
using test::read_reference;
using test::Reference;

// "forces.3.spring" → "forces.*.spring": names and positions under lists and tables of free names.
std::string path_of(const std::string& key) {
  static const Keys kFreeNames{"bodies", "joints", "motions", "forces",  "initial",
                               "points", "force",  "sum",     "product", "pieces"};
  std::istringstream parts(key);
  std::string path, last;
  for (std::string part; std::getline(parts, part, '.');) {
    const bool is_free = kFreeNames.contains(last);
    last = is_free ? "" : part;
    if (!path.empty()) path.push_back('.');
    path.append(is_free ? "*" : part);
  }
  return path;
}

// The section that describes a table, "" for tables whose keys are names.
std::string section_of(const std::string& path, const std::string& type) {
  static const std::map<std::string, std::string> kSections{
      {"", "Vehicle"},
      {"bodies.*", "Bodies"},
      {"bodies.*.points.*", "Points of a superelement"},
      {"motions.*", "Motions"},
      {"motions.*.function", "Functions of time"},
      {"joints.*.length", "Functions of time"},
      {"forces.*.torque", "Functions of time"},
      {"forces.*.force.*", "Functions of time"},
      {"forces.*.free_length", "Forces: static length"},
      {"forces.*.spring", "Laws: spring"},
      {"forces.*.compression_stop", "Laws: stops"},
      {"forces.*.rebound_stop", "Laws: stops"},
      {"forces.*.damper", "Laws: damper"},
      {"forces.*.metering", "Laws: metering"},
      {"forces.*.friction", "Laws: friction"},
      {"forces.*.auxiliary", "Forces: auxiliary volume"},
      {"forces.*.auxiliary.orifice", "Laws: orifice"},
      {"forces.*.partner", "Forces: partner"},
      {"forces.*.partner.line", "Laws: orifice"},
      {"forces.*.levelling", "Forces: levelling"},
      {"forces.*.levelling.orifice", "Laws: orifice"},
      {"forces.*.x", "Laws: direction of a bushing"},
      {"forces.*.y", "Laws: direction of a bushing"},
      {"forces.*.rotation", "Laws: direction of a bushing"},
      {"statistics", "Statistics"},
      {"integrator", "Integrator"},
      {"adaptivity", "Adaptivity"},
      {"mode_choice", "Mode choice"},
      {"output", "Output"},
      {"response", "Response"},
      {"response.road", "Response: road"},
      {"initial.*", "Initial"},
  };
  if (path == "joints.*") return "Joints: " + type;
  if (path == "forces.*") return "Forces: " + type;
  if (path == "output.store" || path == "output.step") return "Output: histories";
  if (path == "road")
    return type == "flat" || type == "random" || type == "table" || type == "opencrg"
               ? "Road: " + (type == "opencrg" ? "OpenCRG" : type)
               : "Road: a bump";
  if (path.ends_with(".history")) return "Functions of time: history";
  if (path.ends_with(".harmonic")) return "Functions of time: harmonic";
  if (path.ends_with(".step")) return "Functions of time: step";
  if (path.ends_with(".pieces.*")) return "Functions of time: pieces";
  for (const char* part : {".sum.*", ".product.*", ".pieces.*.function"}) {
    if (path.ends_with(part)) return "Functions of time";
  }
  for (const char* direction : {".x", ".y", ".rotation"}) {
    if (path.ends_with(std::string(direction) + ".spring")) return "Laws: spring";
    if (path.ends_with(std::string(direction) + ".damper")) return "Laws: damper";
    if (path.ends_with(std::string(direction) + ".relaxation")) return "Laws: relaxation";
  }
  const auto found = kSections.find(path);
  return found == kSections.end() ? "" : found->second;
}

// Tables whose keys are names.
const Keys kTablesOfNames{
    "bodies",  "bodies.*.points", "modes",         "modal_damping", "stiffening", "adaptivity.available",
    "initial", "joint_rates",     "ground.points", "ground"};

struct Found {
  std::map<std::string, Keys> asked, used;  // by section
};

// Walks a document that has been read.
void collect(const support::TomlValue& value, Found& found, const std::string& root_section);
void collect(const support::TomlTable& table, Found& found, const std::string& root_section) {
  const Keys asked(table.asked_keys().begin(), table.asked_keys().end());
  Keys used;
  std::string type;
  for (const auto& [key, value] : table.entries()) {
    used.insert(key);
    if ((key == "type" || key == "shape") && value.is_string()) type = value.string();
    collect(value, found, root_section);
  }
  const std::string path = path_of(table.key());
  if (path == "road" && type.empty()) type = "random";  // a class alone says it
  std::string section = path.empty() ? root_section : section_of(path, type);
  // A run file's [modes] names superelements, not keys.
  if (path == "modes" && root_section == "Vehicle") section = "Quantities that judge";
  if (section.empty()) {
    CAPTURE(path);
    CHECK(kTablesOfNames.contains(path));
    return;
  }
  found.asked[section].insert(asked.begin(), asked.end());
  found.used[section].merge(used);
}
void collect(const support::TomlValue& value, Found& found, const std::string& root_section) {
  if (value.is_table()) collect(value.table(), found, root_section);
  if (!value.is_array()) return;
  for (const support::TomlValue& item : value.items()) collect(item, found, root_section);
}

// The words that an error says a key may have: `must be one of "a", "b"; got …`.
std::vector<std::string> find_allowed(const std::string& message) {
  std::vector<std::string> words;
  const std::size_t end = message.find("; got");
  for (std::size_t at = message.find('"'); at < end; at = message.find('"', at)) {
    const std::size_t close = message.find('"', at + 1);
    words.push_back(message.substr(at + 1, close - at - 1));
    at = close + 1;
  }
  return words;
}

Found read_examples(const Reference& reference) {
  Found found;
  test::write_history();
  const auto vehicle = support::TomlDocument::parse(reference.vehicle, "vehicle example");
  dynamics::read_vehicle(vehicle, test::superelement_folder());
  collect(vehicle.root(), found, "Vehicle");
  for (const std::string& example : reference.runs) {
    const bool is_whole = example.find("vehicle =") != std::string::npos;
    const auto run = support::TomlDocument::parse(
        (is_whole ? "" : "vehicle = \"vehicle.toml\"\nduration = 5.0\n") + example, "run example");
    dynamics::read_run(run);
    collect(run.root(), found, "Run");
  }
  return found;
}

}  // namespace

TEST_CASE("Every type of joint and of force element has a section of the reference") {
  const Reference reference = read_reference();
  for (const auto& [group, title] : {std::pair("joints", "Joints: "), std::pair("forces", "Forces: ")}) {
    const std::string text = fmt::format(
        "name = \"none\"\n[bodies.one]\nmass = 1.0\ninertia = 1.0\nposition = [0.0, 0.0]\n"
        "[[{}]]\nname = \"one\"\ntype = \"none\"\na = \"ground.origin\"\nb = \"one.origin\"\n",
        group);
    std::string message;
    try {
      dynamics::read_vehicle(support::TomlDocument::parse(text, "vehicle"), "");
    } catch (const support::InputError& error) {
      message = error.what();  // names all types
    }
    CAPTURE(message);
    const std::vector<std::string> types = find_allowed(message);
    CHECK(types.size() > 4);
    for (const std::string& type : types) {
      CAPTURE(type);
      CHECK(reference.sections.contains(title + type));
    }
  }
}

TEST_CASE("The reference names exactly the keys that the program reads, and every one has an example") {
  const Reference reference = read_reference();
  const Found found = read_examples(reference);
  CHECK(found.asked.size() > 20);  // sections with keys: the reference was found at all
  for (const auto& [title, keys] : reference.sections) {
    CAPTURE(title);
    REQUIRE(found.asked.contains(title));
    CHECK(keys == found.asked.at(title));
    // Tables of the run file stand in examples of their own.
    Keys used = found.used.at(title);
    CHECK(keys == used);
  }
  for (const auto& [title, keys] : found.asked) {
    CAPTURE(title);
    CHECK(reference.sections.contains(title));
  }
}

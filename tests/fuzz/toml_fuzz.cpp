// TOML documents and overrides: the first line of the input is an assignment as after --set, the rest the
// document.
#include <string>

#include "tools/support/toml/toml.h"

namespace {

using namespace sprung::support;

// Asks each value for each type, as readers do.
void convert_all(const TomlValue& value) {
  const auto attempt = [](auto&& conversion) {
    try {
      conversion();
    } catch (const InputError&) {
    }
  };
  attempt([&] { value.number(positive("m")); });
  attempt([&] { value.integer(1, 10); });
  attempt([&] { value.boolean(); });
  attempt([&] { value.string(); });
  attempt([&] { value.numbers(any("m"), 2); });
  if (value.is_array()) {
    for (const TomlValue& item : value.items()) convert_all(item);
  }
  if (!value.is_table()) return;
  const TomlTable table = value.table();
  attempt([&] { static_cast<void>(table.at("mass")); });
  attempt([&] { table.reject_unknown_keys(); });
  for (const auto& [key, entry] : table.entries()) convert_all(entry);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(input.find('\n'), input.size());
  const auto read = [](const std::string& text, const std::string& assignment) {
    try {
      TomlDocument document = TomlDocument::parse(text, "input.toml");
      if (!assignment.empty()) document.set(assignment, "--set 1");
      for (const auto& [key, value] : document.root().entries()) convert_all(value);
    } catch (const InputError&) {
    }
  };
  read(input.substr(std::min(end + 1, size)), input.substr(0, end));
  read(input, "");
  return 0;
}

#include "tools/support/toml/toml_parser.h"

#include <fmt/format.h>

// toml++ asserts what a document may break (`[=]`), before it looks for the fault and tells it: its assertion
// is left out in every build, so that the fault is told. In an optimised build it would be a promise to the
// compiler.
#ifdef NDEBUG
#undef NDEBUG
#define SPRUNG_NDEBUG
#endif
#define TOML_ASSERT(expression) static_assert(true)
#include <toml++/toml.h>
#ifdef SPRUNG_NDEBUG
#define NDEBUG
#endif

#include <algorithm>

#include "tools/support/toml/toml_text.h"

namespace sprung::support {

namespace {

// Converts the library's tree. Its tables are sorted by key; the places of the keys restore the order of the
// text.
class Converter {
 public:
  explicit Converter(const std::string& name) : name_(name) {}

  TomlNode convert(const toml::node& node, std::string key, const SourceLocation& key_location) const {
    TomlNode result;
    result.key_location = key_location;
    result.location = place(node.source().begin, key_location);
    result.key = std::move(key);
    if (const auto* table = node.as_table()) {
      result.value = convert_table(*table, result);
    } else if (const auto* array = node.as_array()) {
      result.value = convert_array(*array, result);
    } else if (const auto* text = node.as_string()) {
      if (text->get().find('\0') != std::string::npos) {
        throw InputError(result.location, fmt::format("'{}' contains the character NUL", result.key));
      }
      result.value = text->get();
    } else if (const auto* integer = node.as_integer()) {
      result.value = integer->get();
    } else if (const auto* real = node.as_floating_point()) {
      result.value = real->get();
    } else if (const auto* boolean = node.as_boolean()) {
      result.value = boolean->get();
    } else {
      throw InputError(result.location,
                       fmt::format("'{}' is a date or time, which no key takes", result.key));
    }
    return result;
  }

 private:
  SourceLocation place(const toml::source_position& position, const SourceLocation& otherwise) const {
    if (!position) return otherwise;
    return {
        .path = name_, .line = static_cast<int>(position.line), .column = static_cast<int>(position.column)};
  }

  TomlNode::Table convert_table(const toml::table& table, const TomlNode& parent) const {
    TomlNode::Table result;
    for (auto&& [key, node] : table) {
      const SourceLocation key_location = place(key.source().begin, parent.location);
      result.entries.push_back({.key = std::string(key.str()),
                                .node = convert(node, join_key(parent.key, key.str()), key_location)});
    }
    std::stable_sort(result.entries.begin(), result.entries.end(), [](const auto& a, const auto& b) {
      const SourceLocation& first = a.node.key_location;
      const SourceLocation& second = b.node.key_location;
      return first.line != second.line ? first.line < second.line : first.column < second.column;
    });
    return result;
  }

  TomlNode::Array convert_array(const toml::array& array, const TomlNode& parent) const {
    TomlNode::Array result;
    for (std::size_t i = 0; i < array.size(); ++i) {
      const toml::node& item = array[i];
      const SourceLocation location = place(item.source().begin, parent.location);
      result.items.push_back(convert(item, join_key(parent.key, name_of(item, i)), location));
    }
    return result;
  }

  // The last part of an element's key: its `name` if it is a table with one, otherwise its position.
  static std::string name_of(const toml::node& item, std::size_t position) {
    const auto* table = item.as_table();
    const auto* name = table != nullptr ? table->get_as<std::string>("name") : nullptr;
    return name != nullptr && !name->get().empty() ? name->get() : std::to_string(position);
  }

  const std::string& name_;
};

}  // namespace

TomlNode parse_toml(std::string_view text, const std::string& name) {
  // The library takes a level of the stack for each part, without a limit.
  constexpr std::size_t kMostParts = 256;
  if (const std::size_t begin = find_deep_key(text, kMostParts); begin != std::string_view::npos) {
    const std::string_view before = text.substr(0, begin);
    const std::size_t line_begin = before.rfind('\n') + 1;
    throw InputError({.path = name,
                      .line = 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
                      .column = 1 + static_cast<int>(begin - line_begin)},
                     fmt::format("a key of more than {} parts", kMostParts));
  }
  try {
    const toml::table table = toml::parse(text, name);
    TomlNode root = Converter(name).convert(table, "", {.path = name});
    root.location = {.path = name};  // the file as a whole
    return root;
  } catch (const toml::parse_error& error) {
    const toml::source_position begin = error.source().begin;
    const std::string_view what = error.description();
    // The library quotes the number that it cannot read.
    const std::size_t first = what.find('\'') + 1, last = what.find('\'', first);
    const std::string number = first == 0 || last == std::string_view::npos
                                   ? ""
                                   : describe_unreadable_number(what.substr(first, last - first));
    throw InputError(
        {.path = name, .line = static_cast<int>(begin.line), .column = static_cast<int>(begin.column)},
        number.empty() ? fmt::format("is not TOML: {}", what) : number);
  }
}

}  // namespace sprung::support

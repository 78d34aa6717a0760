#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "tools/support/toml/toml.h"
#include "tools/support/toml/toml_parser.h"
#include "tools/support/toml/toml_text.h"

namespace sprung::support {

namespace {

struct KeyPart {
  std::string text;
  bool quoted = false;  // a quoted number is a name, not a position
};

struct Assignment {
  std::vector<KeyPart> path;
  std::string_view value;
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

// One part of a key path, as written.
KeyPart read_part(std::string_view text, const InputError& malformed) {
  text = trimmed(text);
  if (text.empty()) throw malformed;
  const char quote = text.front();
  if (quote != '"' && quote != '\'') {
    if (text.find_first_of("\"'") != std::string_view::npos) throw malformed;
    return {.text = std::string(text)};
  }
  if (text.size() < 2 || text.find(quote, 1) != text.size() - 1) throw malformed;
  return {.text = std::string(text.substr(1, text.size() - 2)), .quoted = true};
}

// Splits `a."b.c".d = value` at the dots and at the first '=' that are outside quotes.
Assignment split(std::string_view text, const std::string& where) {
  const InputError malformed({.path = where}, fmt::format("'{}' is not of the form key.path=value", text));
  Assignment assignment;
  char quote = '\0';
  std::size_t start = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '.' || c == '=') {
      assignment.path.push_back(read_part(text.substr(start, i - start), malformed));
      start = i + 1;
      if (c == '.') continue;
      assignment.value = trimmed(text.substr(start));
      if (assignment.value.empty()) throw malformed;
      return assignment;
    }
  }
  throw malformed;
}

const std::string* find_name(const TomlNode& node) {
  const auto* table = std::get_if<TomlNode::Table>(&node.value);
  if (table == nullptr) return nullptr;
  for (const auto& [key, entry] : table->entries) {
    if (key == "name") return std::get_if<std::string>(&entry.value);
  }
  return nullptr;
}

// Gives a value, and all that is in it, the place of the override and its key in the document.
void relocate(TomlNode& node, const SourceLocation& location, const std::string& key) {
  node.location = location;
  node.key_location = location;
  node.key = key;
  if (auto* table = std::get_if<TomlNode::Table>(&node.value)) {
    for (auto& [name, entry] : table->entries) relocate(entry, location, join_key(key, name));
  } else if (auto* array = std::get_if<TomlNode::Array>(&node.value)) {
    for (std::size_t i = 0; i < array->items.size(); ++i) {
      const std::string* item = find_name(array->items[i]);
      relocate(array->items[i], location,
               join_key(key, item != nullptr && !item->empty() ? *item : std::to_string(i)));
    }
  }
}

// A TOML value, or a bare word, which needs no quotes on a command line.
TomlNode parse_value(std::string_view text, const SourceLocation& location) {
  constexpr std::string_view kName = "value";
  try {
    TomlNode root = parse_toml(fmt::format("{} = {}", kName, text), location.path);
    auto& entries = std::get<TomlNode::Table>(root.value).entries;
    if (entries.size() == 1 && entries.front().key == kName) return std::move(entries.front().node);
  } catch (const InputError&) {
    if (const std::string number = describe_unreadable_number(text); !number.empty())
      throw InputError(location, number);
    constexpr std::string_view kNotBare = "\"'[]{}\n";
    if (text.find_first_of(kNotBare) == std::string_view::npos) {
      TomlNode word;
      word.value = std::string(text);
      return word;
    }
  }
  throw InputError(location, fmt::format("'{}' is not a TOML value", text));
}

std::optional<std::size_t> read_position(const KeyPart& part) {
  std::size_t position = 0;
  const char* end = part.text.data() + part.text.size();
  const std::from_chars_result result = std::from_chars(part.text.data(), end, position);
  if (part.quoted || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return position;
}

// The element of an array by its position or, a table, by its name.
TomlNode& find_element(TomlNode& node, TomlNode::Array& array, const KeyPart& part,
                       const SourceLocation& location) {
  if (const std::optional<std::size_t> position = read_position(part)) {
    if (*position < array.items.size()) return array.items[*position];
    throw InputError(location, fmt::format("'{}' is {}, counted from 0: it has no {}", node.key,
                                           describe(node), *position));
  }
  std::vector<std::string> names;
  TomlNode* found = nullptr;
  for (TomlNode& item : array.items) {
    const std::string* name = find_name(item);
    if (name == nullptr) continue;
    names.push_back(*name);
    if (*name != part.text) continue;
    if (found != nullptr) {
      throw InputError(location, fmt::format("'{}' has several elements named '{}'", node.key, part.text));
    }
    found = &item;
  }
  if (found != nullptr) return *found;
  throw InputError(location, fmt::format("'{}' has no element named '{}'{}", node.key, part.text,
                                         nearest_name_hint(part.text, names)));
}

// The entry of a table; it is made if it is missing.
TomlNode& find_or_make_entry(TomlNode& node, TomlNode::Table& table, const std::string& name,
                             const SourceLocation& location) {
  for (auto& [key, entry] : table.entries) {
    if (key == name) return entry;
  }
  TomlNode made;
  made.location = location;
  made.key_location = location;
  made.key = join_key(node.key, name);
  made.value = TomlNode::Table{};
  table.entries.push_back({name, std::move(made)});
  return table.entries.back().node;
}

TomlNode& descend(TomlNode& node, const KeyPart& part, const SourceLocation& location) {
  if (auto* table = std::get_if<TomlNode::Table>(&node.value)) {
    return find_or_make_entry(node, *table, part.text, location);
  }
  if (auto* array = std::get_if<TomlNode::Array>(&node.value))
    return find_element(node, *array, part, location);
  throw InputError(location, fmt::format("'{}' is {}, not a table: it has no key '{}'", node.key,
                                         describe(node), part.text));
}

}  // namespace

void TomlDocument::set(std::string_view assignment, const std::string& where) {
  const SourceLocation location{.path = where};
  const Assignment parts = split(assignment, where);
  TomlNode value = parse_value(parts.value, location);
  TomlNode* node = root_.get();
  for (const KeyPart& part : parts.path) node = &descend(*node, part, location);
  relocate(value, location, node->key);
  *node = std::move(value);
}

}  // namespace sprung::support

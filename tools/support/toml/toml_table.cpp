#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tools/support/toml/toml.h"
#include "tools/support/toml/toml_text.h"

namespace sprung::support {

namespace {

const TomlNode::Table& table_of(const TomlNode& node) {
  if (const auto* table = std::get_if<TomlNode::Table>(&node.value)) return *table;
  throw TomlValue(node).error(fmt::format("must be a table, got {}", describe(node)));
}

void remember(const TomlNode::Table& table, std::string_view key) {
  if (std::find(table.asked.begin(), table.asked.end(), key) == table.asked.end())
    table.asked.emplace_back(key);
}

// " in 'bodies.chassis'", or nothing for the root.
std::string within(const std::string& key) {
  return key.empty() ? "" : fmt::format(" in '{}'", key);
}

}  // namespace

TomlTable::TomlTable(const TomlNode& node) : node_(&node), table_(&table_of(node)) {}

std::optional<TomlValue> TomlTable::find(std::string_view key) const {
  remember(*table_, key);
  for (const auto& [name, node] : table_->entries) {
    if (name == key) return TomlValue(node);
  }
  return std::nullopt;
}

TomlValue TomlTable::at(std::string_view key) const {
  if (const std::optional<TomlValue> value = find(key)) return *value;
  // A required key that was misspelt is there under another name.
  std::vector<std::string> unasked;
  for (const auto& [name, node] : table_->entries) {
    if (std::find(table_->asked.begin(), table_->asked.end(), name) == table_->asked.end())
      unasked.push_back(name);
  }
  const std::string misspelt = key.size() > 3 ? find_nearest_name(key, unasked) : "";
  throw InputError(location(),
                   fmt::format("missing key '{}'{}{}", key, within(node_->key),
                               misspelt.empty() ? "" : fmt::format("; is '{}' meant to be it?", misspelt)));
}

std::vector<std::pair<std::string, TomlValue>> TomlTable::entries() const {
  std::vector<std::pair<std::string, TomlValue>> all;
  for (const auto& [name, node] : table_->entries) {
    remember(*table_, name);
    all.emplace_back(name, TomlValue(node));
  }
  return all;
}

double TomlTable::number_or(std::string_view key, double fallback, const Quantity& quantity) const {
  const std::optional<TomlValue> value = find(key);
  return value ? value->number(quantity) : fallback;
}

std::int64_t TomlTable::integer_or(std::string_view key, std::int64_t fallback, std::int64_t minimum,
                                   std::int64_t maximum) const {
  const std::optional<TomlValue> value = find(key);
  return value ? value->integer(minimum, maximum) : fallback;
}

bool TomlTable::boolean_or(std::string_view key, bool fallback) const {
  const std::optional<TomlValue> value = find(key);
  return value ? value->boolean() : fallback;
}

std::string TomlTable::string_or(std::string_view key, std::string_view fallback) const {
  const std::optional<TomlValue> value = find(key);
  return value ? value->string() : std::string(fallback);
}

std::optional<TomlTable> TomlTable::find_table(std::string_view key) const {
  const std::optional<TomlValue> value = find(key);
  return value ? std::optional<TomlTable>(value->table()) : std::nullopt;
}

void TomlTable::reject_unknown_keys() const {
  const std::vector<std::string>& asked = table_->asked;
  for (const auto& [name, node] : table_->entries) {
    if (std::find(asked.begin(), asked.end(), name) != asked.end()) continue;
    std::string hint = nearest_name_hint(name, asked);
    if (hint.empty() && !asked.empty()) hint = fmt::format(" (known keys: {})", fmt::join(asked, ", "));
    throw InputError(node.key_location, fmt::format("unknown key '{}'{}{}", name, within(node_->key), hint));
  }
}

std::span<const std::string> TomlTable::asked_keys() const {
  return table_->asked;
}

InputError TomlTable::error(std::string_view message) const {
  if (node_->key.empty()) return InputError(location(), message);
  return InputError(location(), fmt::format("'{}' {}", node_->key, message));
}

}  // namespace sprung::support

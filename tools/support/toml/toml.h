#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tools/support/errors/input_error.h"

namespace sprung::support {

/// The range that a number must lie in. NaN, infinity and what toml_value.cpp calls too large never do.
struct Quantity {
  std::string_view unit;                ///< for the message, "" for a pure number
  std::optional<double> above = {};     ///< value > above
  std::optional<double> at_least = {};  ///< value ≥ at_least
  std::optional<double> at_most = {};   ///< value ≤ at_most
};
constexpr Quantity any(std::string_view unit) {
  return {.unit = unit};
}
constexpr Quantity positive(std::string_view unit) {
  return {.unit = unit, .above = 0.0};
}
constexpr Quantity non_negative(std::string_view unit) {
  return {.unit = unit, .at_least = 0.0};
}

/// A value of a TOML document, its place in the text and its full key ("bodies.chassis.mass").
struct TomlNode {
  struct Array {
    std::vector<TomlNode> items;
  };
  struct Entry;
  struct Table {
    std::vector<Entry> entries;              ///< in the order of the file
    mutable std::vector<std::string> asked;  ///< keys that the program has looked up
  };
  SourceLocation location;      ///< of the value
  SourceLocation key_location;  ///< of its key; of the value itself for array elements
  /// Full key. Elements of arrays go by their `name`, "forces.front_tyre.damping", or by their 0-based
  /// position, "forces.2.stiffness".
  std::string key;
  std::variant<bool, std::int64_t, double, std::string, Array, Table> value;
};

/// A key of a table with its value; clang cannot have a std::pair in its place.
struct TomlNode::Entry {
  std::string key;
  TomlNode node;
};

class TomlTable;

/// A value to be converted. Each conversion throws InputError at the place of the value if its type or range
/// is wrong.
class TomlValue {
 public:
  explicit TomlValue(const TomlNode& node) : node_(&node) {}

  const SourceLocation& location() const { return node_->location; }
  const std::string& key() const { return node_->key; }  ///< full key, for messages

  bool is_table() const;
  bool is_array() const;
  bool is_string() const;
  bool is_integer() const;
  bool is_number() const;  ///< integer or real

  bool boolean() const;
  double number(const Quantity& quantity) const;
  std::int64_t integer(std::int64_t minimum, std::int64_t maximum) const;
  const std::string& string() const;
  std::vector<TomlValue> items() const;                         ///< of an array
  std::vector<double> numbers(const Quantity& quantity) const;  ///< array of any length
  std::vector<double> numbers(const Quantity& quantity, std::size_t count) const;
  TomlTable table() const;

  /// A string that must be one of the words; the error lists them and names the most similar one.
  const std::string& one_of(std::span<const std::string> words) const;

  /// The error to throw at this value: "'key' " + message.
  [[nodiscard]] InputError error(std::string_view message) const;

 private:
  const TomlNode* node_;
};

/// A table that records which keys are looked up, so that `reject_unknown_keys` finds misspelt ones.
class TomlTable {
 public:
  explicit TomlTable(const TomlNode& node);

  const SourceLocation& location() const { return node_->location; }
  const std::string& key() const { return node_->key; }

  bool has(std::string_view key) const { return find(key).has_value(); }
  std::optional<TomlValue> find(std::string_view key) const;  ///< none if the key is missing
  TomlValue at(std::string_view key) const;                   ///< throws InputError naming the missing key
  std::vector<std::pair<std::string, TomlValue>> entries() const;  ///< all; each counts as looked up

  double number(std::string_view key, const Quantity& quantity) const { return at(key).number(quantity); }
  double number_or(std::string_view key, double fallback, const Quantity& quantity) const;
  std::int64_t integer_or(std::string_view key, std::int64_t fallback, std::int64_t minimum,
                          std::int64_t maximum) const;
  bool boolean_or(std::string_view key, bool fallback) const;
  const std::string& string(std::string_view key) const { return at(key).string(); }
  std::string string_or(std::string_view key, std::string_view fallback) const;
  std::optional<TomlTable> find_table(std::string_view key) const;

  /// Throws InputError for the first key that was not looked up, and names the most similar one that was. To
  /// be called after a table has been read.
  void reject_unknown_keys() const;
  /// The keys that have been looked up so far, present or not.
  std::span<const std::string> asked_keys() const;

  /// The error to throw at this table: "'key' " + message.
  [[nodiscard]] InputError error(std::string_view message) const;

 private:
  const TomlNode* node_;
  const TomlNode::Table* table_;
};

/// A parsed document. TomlTable and TomlValue refer to it and must not outlive it.
class TomlDocument {
 public:
  /// @throws InputError if the file cannot be read, or at the place where it is not TOML
  static TomlDocument read(const std::filesystem::path& path);
  /// @param name  used in place of the path in messages
  static TomlDocument parse(std::string text, const std::string& name);

  /// Overrides one key by `key.path=value`. The value is written as in TOML; a bare word is a string. Missing
  /// tables of the path are made. `name.3.key` selects an element of an array by its 0-based position; tables
  /// in an array may also be selected by their `name`. A TomlValue of a replaced value becomes invalid.
  /// @param where  used in place of the path in messages: "--set 1"
  /// @throws InputError if it is not an assignment, or if the path leads through a value that is neither a
  /// table nor an array
  void set(std::string_view assignment, const std::string& where);

  TomlTable root() const { return TomlTable(*root_); }
  const std::string& text() const { return text_; }  ///< as read, without overrides
  const std::string& name() const { return name_; }

 private:
  TomlDocument() = default;
  std::unique_ptr<TomlNode> root_;  // by pointer, so that views survive a move
  std::string text_;
  std::string name_;
};

}  // namespace sprung::support

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

/// What a number read from a file must satisfy; NaN and infinity never do.
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

/// A value of a TOML document with the place it was written at and its full key ("bodies.chassis.mass").
struct TomlNode {
  struct Array {
    std::vector<TomlNode> items;
  };
  struct Entry;
  struct Table {
    std::vector<Entry> entries;              ///< in the order of the file
    mutable std::vector<std::string> asked;  ///< keys the program has asked for
  };
  SourceLocation location;      ///< of the value
  SourceLocation key_location;  ///< of its key; the value's own place for array elements
  std::string key;              ///< full, array elements by 0-based position: "forces.2.stiffness"
  std::variant<bool, std::int64_t, double, std::string, Array, Table> value;
};

/// A key of a table with its value; clang cannot have a std::pair in its place.
struct TomlNode::Entry {
  std::string key;
  TomlNode node;
};

class TomlTable;

/// A value to be converted; each conversion throws InputError at the value's place when type or range do not
/// fit.
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

  /// One of the words; the error lists them and names the nearest.
  const std::string& one_of(std::span<const std::string> words) const;

  /// The error to throw at this value: "'key' " + message.
  [[nodiscard]] InputError error(std::string_view message) const;

 private:
  const TomlNode* node_;
};

/// A table that remembers which keys were asked for, so that `reject_unknown_keys` finds the misspelt ones.
class TomlTable {
 public:
  explicit TomlTable(const TomlNode& node);

  const SourceLocation& location() const { return node_->location; }
  const std::string& key() const { return node_->key; }

  bool has(std::string_view key) const { return find(key).has_value(); }
  std::optional<TomlValue> find(std::string_view key) const;  ///< asked for, may be absent
  TomlValue at(std::string_view key) const;                   ///< throws InputError naming the missing key
  std::vector<std::pair<std::string, TomlValue>> entries() const;  ///< all of them, all taken as asked for

  double number(std::string_view key, const Quantity& quantity) const { return at(key).number(quantity); }
  double number_or(std::string_view key, double fallback, const Quantity& quantity) const;
  std::int64_t integer_or(std::string_view key, std::int64_t fallback, std::int64_t minimum,
                          std::int64_t maximum) const;
  bool boolean_or(std::string_view key, bool fallback) const;
  const std::string& string(std::string_view key) const { return at(key).string(); }
  std::string string_or(std::string_view key, std::string_view fallback) const;
  std::optional<TomlTable> find_table(std::string_view key) const;

  /// Throws InputError for the first key nobody asked for, naming the nearest that was. Call after reading a
  /// table.
  void reject_unknown_keys() const;
  /// The keys the program has asked this table for so far, present or not.
  std::span<const std::string> asked_keys() const;

  /// The error to throw at this table: "'key' " + message.
  [[nodiscard]] InputError error(std::string_view message) const;

 private:
  const TomlNode* node_;
  const TomlNode::Table* table_;
};

/// A parsed document. Views (TomlTable, TomlValue) live as long as the document does.
class TomlDocument {
 public:
  /// @throws InputError if the file cannot be read or is not TOML (place of the fault).
  static TomlDocument read(const std::filesystem::path& path);
  /// @param name  stands for the path in messages
  static TomlDocument parse(std::string text, const std::string& name);

  /// Overrides one key: `key.path=value`, value as in TOML, a bare word being a string. Tables on the way are
  /// made; `name.3.key` reaches into an array by its 0-based position or, for tables, by their `name`. Views
  /// of a value that is replaced end here.
  /// @param where  stands for the path in messages, e.g. "--set 1"
  /// @throws InputError if it is no assignment, or the path runs through a value that is neither table nor
  /// array
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

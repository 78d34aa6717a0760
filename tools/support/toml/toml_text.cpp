#include "tools/support/toml/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sprung::support {

namespace {

bool is_bare_key_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

// The last character of the string that begins with the quote at `first`; where it has no end, that of its
// line or of the text.
std::size_t find_end_of_string(std::string_view text, std::size_t first) {
  const char quote = text[first];
  const auto has_three = [&](std::size_t i) { return text.substr(i, 3) == std::string(3, quote); };
  const bool is_long = has_three(first);
  for (std::size_t i = first + (is_long ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (is_long && has_three(i)) {
      // Up to two further quotes belong to the string.
      for (int more = 0; more < 2 && text.substr(i + 3, 1) == std::string(1, quote); ++more) ++i;
      return i + 2;
    } else if (!is_long && (text[i] == quote || text[i] == '\n')) {
      return i;
    }
  }
  return text.size() - 1;
}

// At most 40 bytes, cut between code points.
std::string shortened(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  if (text.size() <= kLongest) return std::string(text);
  std::size_t size = kLongest;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return std::string(text.substr(0, size)) + "…";
}

}  // namespace

std::string join_key(std::string_view parent, std::string_view part) {
  const bool bare = !part.empty() && std::all_of(part.begin(), part.end(), is_bare_key_character);
  const char quote = part.find('"') == std::string_view::npos ? '"' : '\'';
  const std::string text = bare ? std::string(part) : fmt::format("{0}{1}{0}", quote, part);
  return parent.empty() ? text : fmt::format("{}.{}", parent, text);
}

std::string format_number(double value) {
  return fmt::format("{}", value);
}

std::string describe(const TomlNode& node) {
  struct Describe {
    std::string operator()(bool value) const { return fmt::format("a boolean {}", value); }
    std::string operator()(std::int64_t value) const { return fmt::format("an integer {}", value); }
    std::string operator()(double value) const {
      const bool whole = std::isfinite(value) && value == std::trunc(value);
      const std::string text = format_number(value);
      return fmt::format("a number {}{}", text, whole && text.find('e') == std::string::npos ? ".0" : "");
    }
    std::string operator()(const std::string& value) const {
      return fmt::format("a string \"{}\"", shortened(value));
    }
    std::string operator()(const TomlNode::Array& value) const {
      return fmt::format("an array of {}", value.items.size());
    }
    std::string operator()(const TomlNode::Table&) const { return "a table"; }
  };
  return std::visit(Describe{}, node.value);
}

std::string describe_unreadable_number(std::string_view text) {
  std::string digits(text);
  std::erase(digits, '_');
  const char* begin = digits.data() + (digits.starts_with('+') ? 1 : 0);
  const char* end = digits.data() + digits.size();
  double value = 0.0;
  const std::from_chars_result as_double = std::from_chars(begin, end, value);
  if (as_double.ptr != end) return "";
  if (as_double.ec == std::errc::result_out_of_range) {
    const bool is_small = digits.find("e-") != std::string::npos || digits.find("E-") != std::string::npos;
    return is_small ? fmt::format("{} is too small for double precision, whose smallest number is {:.2g}",
                                  text, std::numeric_limits<double>::min())
                    : fmt::format("{} is too large for double precision, whose largest number is {:.2g}",
                                  text, std::numeric_limits<double>::max());
  }
  std::int64_t integer = 0;
  const std::from_chars_result as_integer = std::from_chars(begin, end, integer);
  if (as_integer.ptr != end || as_integer.ec != std::errc::result_out_of_range) return "";
  return fmt::format("{} is too large for an integer, which has 64 bits; a number is written as {:g}", text,
                     value);
}

std::size_t find_deep_key(std::string_view text, std::size_t most) {
  std::size_t dots = 0, begin = 0;
  bool is_in_key = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const std::size_t first = i;
    const bool is_quote = c == '"' || c == '\'';
    if (c == '#') i = std::min(text.find('\n', i), text.size());
    if (is_quote) i = find_end_of_string(text, i);
    if (is_quote || is_bare_key_character(c) || c == '.') {
      if (!is_in_key) begin = first;
      is_in_key = true;
      dots += c == '.' ? 1 : 0;
      if (dots >= most) return begin;
    } else if (c != ' ' && c != '\t') {
      is_in_key = false;
      dots = 0;
    }
  }
  return std::string_view::npos;
}

}  // namespace sprung::support

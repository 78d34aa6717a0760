#include "reduce/matrices/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tools/support/files/read_text_file.h"

namespace sprung::reduce {

namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// A number as C++ writes it: an exponent with D, or with nothing but its sign, gets its E; no plus in front.
std::string to_plain_number(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_sign = c == '+' || c == '-';
    if (i == 0 && c == '+') continue;
    if (c == 'D' || c == 'd') {
      plain += 'e';
    } else {
      if (is_sign && i > 0 && (text[i - 1] == '.' || (text[i - 1] >= '0' && text[i - 1] <= '9')))
        plain += 'e';
      if (c != '+') plain += c;
    }
  }
  return plain;
}

}  // namespace

TextLines::TextLines(const std::filesystem::path& path)
    : path_(path.string()), text_(support::read_text_file(path)), rest_(text_) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_ = end == rest_.npos ? std::string_view{} : rest_.substr(end + 1);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++number_;
  if (end == line_.npos)
    throw error(
        "the file ends within a line, so it may have been cut off; expected a line end after the last line");
  return true;
}

std::vector<TextField> TextLines::fields() const {
  constexpr std::string_view kSeparators = " \t\r\v\f,";
  std::vector<TextField> fields;
  for (std::size_t begin = line_.find_first_not_of(kSeparators); begin != line_.npos;) {
    const std::size_t end = std::min(line_.find_first_of(kSeparators, begin), line_.size());
    fields.push_back({line_.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line_.find_first_not_of(kSeparators, end);
  }
  return fields;
}

std::vector<TextField> TextLines::cells() const {
  std::vector<TextField> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line_.find(',', begin), line_.size());
    const std::string_view text = trim(line_.substr(begin, end - begin));
    const auto offset = text.empty() ? begin : static_cast<std::size_t>(text.data() - line_.data());
    cells.push_back({text, static_cast<int>(offset) + 1});
    if (end == line_.size()) return cells;
    begin = end + 1;
  }
}

double TextLines::real(const TextField& field) const {
  const std::string plain = to_plain_number(field.text);
  double value = 0.0;
  const auto [end, fault] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (fault != std::errc() || end != plain.data() + plain.size() || plain.empty()) {
    throw error(field, fmt::format("'{}' is no number of a double's range", field.text));
  }
  if (!std::isfinite(value)) throw error(field, fmt::format("'{}' is not finite", field.text));
  return value;
}

std::int64_t TextLines::integer(const TextField& field, std::int64_t smallest, std::int64_t largest) const {
  std::int64_t value = 0;
  const char* const last = field.text.data() + field.text.size();
  const auto [end, fault] = std::from_chars(field.text.data(), last, value);
  if (fault != std::errc() || end != last || field.text.empty() || value < smallest || value > largest) {
    throw error(field, fmt::format("'{}' is no whole number of {} … {}", field.text, smallest, largest));
  }
  return value;
}

support::InputError TextLines::error(std::string_view message) const {
  return support::InputError({.path = path_, .line = number_}, message);
}

support::InputError TextLines::error(const TextField& field, std::string_view message) const {
  return support::InputError({.path = path_, .line = number_, .column = field.column}, message);
}

}  // namespace sprung::reduce

#include "tests/mutations.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace sprung::test {

namespace {

constexpr std::string_view kDigits = "0123456789";

// The numbers in a text: [begin, end) of each. What stands in a word, as the 1 of "rail1", is none.
std::vector<std::pair<std::size_t, std::size_t>> find_numbers(std::string_view text) {
  const auto is_word = [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  std::vector<std::pair<std::size_t, std::size_t>> numbers;
  for (std::size_t i = 0; (i = text.find_first_of(kDigits, i)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", i), text.size());
    std::size_t begin = i;
    if (begin > 0 && text[begin - 1] == '-') --begin;
    if (begin == 0 || !is_word(text[begin - 1])) numbers.emplace_back(begin, end);
    i = end;
  }
  return numbers;
}

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t size = std::min(text.find('\n'), text.size() - 1) + 1;
    lines.emplace_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return lines;
}

}  // namespace

// Source: [Steele, Lea & Flood 2014], splitmix64
std::size_t Mutations::below(std::size_t limit) {
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return static_cast<std::size_t>(z % limit);
}

std::string Mutations::any_number() {
  static const std::array<const char*, 20> kNumbers{
      "0",          "1",           "2",     "-1",         "3",
      "15",         "100",         "99999", "2147483647", "-2147483648",
      "4294967296", "99999999999", "9e18",  "1e308",      "-1e300",
      "1e-308",     "0.5",         "1e10",  "1e150",      "9223372036854775807"};
  return kNumbers[below(kNumbers.size())];
}

void Mutations::replace_number(std::string& text) {
  const auto numbers = find_numbers(text);
  if (numbers.empty()) return;
  const auto [begin, end] = numbers[below(numbers.size())];
  std::string number = any_number();
  // Half of them of another power of ten than before, with the digits that were there.
  if (below(2) == 0) {
    const std::string old = text.substr(begin, end - begin);
    const std::string digits = old.substr(0, old.find_first_of("eE"));
    number = digits + "e" + std::to_string(static_cast<int>(below(600)) - 300);
  }
  text.replace(begin, end - begin, number);
}

void Mutations::change_lines(std::string& text) {
  std::vector<std::string> lines = split_lines(text);
  if (lines.empty()) return;
  const auto at = [&](std::size_t i) { return lines.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t i = below(lines.size()), j = below(lines.size());
  switch (below(3)) {
    case 0:
      lines.erase(at(i));
      break;
    case 1:
      lines.insert(at(j), std::string(lines[i]));
      break;
    default:
      std::swap(lines[i], lines[j]);
  }
  text.clear();
  for (const std::string& line : lines) text += line;
}

void Mutations::damage_once(std::string& text) {
  if (text.empty()) return;
  const std::size_t i = below(text.size());
  const std::size_t size = std::min(text.size() - i, 1 + below(40));
  switch (below(8)) {
    case 0:
      text[i] = static_cast<char>(below(256));
      break;
    case 1:
      text[i] = static_cast<char>(text[i] ^ (1 << below(8)));
      break;
    case 2:
      text.erase(i, size);
      break;
    case 3:
      text.insert(below(text.size()), text.substr(i, size));
      break;
    case 4:
      change_lines(text);
      break;
    case 5:
      if (below(4) == 0) text.resize(i);
      break;
    default:
      replace_number(text);
  }
}

std::string Mutations::damage(std::string_view whole) {
  std::string text(whole);
  for (std::size_t times = 1 + below(3); times > 0; --times) damage_once(text);
  return text;
}

std::string Mutations::change_numbers(std::string_view whole) {
  std::string text(whole);
  for (std::size_t times = 1 + below(2); times > 0; --times) replace_number(text);
  return text;
}

}  // namespace sprung::test

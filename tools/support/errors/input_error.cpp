#include "tools/support/errors/input_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sprung::support {

namespace {

std::string format_message(const SourceLocation& where, std::string_view message) {
  const std::string place = format_place(where);
  return fmt::format("{}{}error: {}", place, place.empty() ? "" : ": ", message);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& letter : lower) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return lower;
}

// Levenshtein distance; a letter changed, added or left out costs 1.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string format_place(const SourceLocation& where) {
  if (where.path.empty() || where.line <= 0) return where.path;
  if (where.column <= 0) return fmt::format("{}:{}", where.path, where.line);
  return fmt::format("{}:{}:{}", where.path, where.line, where.column);
}

InputError::InputError(const SourceLocation& where, std::string_view message)
    : std::runtime_error(format_message(where, message)) {}

bool is_plain_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), is_plain);
}

std::string find_nearest_name(std::string_view name, std::span<const std::string> candidates) {
  std::string nearest;
  std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(lower_case(name), lower_case(candidate));
    if (distance < std::min(best, candidate.size())) {  // with one letter of it at least
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string nearest_name_hint(std::string_view name, std::span<const std::string> candidates) {
  const std::string nearest = find_nearest_name(name, candidates);
  return nearest.empty() ? nearest : fmt::format(" (did you mean '{}'?)", nearest);
}

}  // namespace sprung::support

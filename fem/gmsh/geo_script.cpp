#include "fem/gmsh/geo_script.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <vector>

namespace sprung::fem {

namespace {

using Tokens = std::vector<std::string_view>;  // of the text: words, numbers, strings, single characters

bool begins_word(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_quote(char c) {
  return c == '"' || c == '\'';
}

// The end of what begins at a place: of a comment, a string, a word, a number, or one character.
std::size_t find_end(std::string_view text, std::size_t at) {
  const auto behind = [&](std::string_view ending, std::size_t from) {
    const std::size_t found = text.find(ending, from);
    return found == text.npos ? text.size() : found + ending.size();
  };
  if (text.substr(at, 2) == "//") return behind("\n", at);
  if (text.substr(at, 2) == "/*") return behind("*/", at + 2);
  if (is_quote(text[at])) return behind(text.substr(at, 1), at + 1);
  std::size_t end = at + 1;
  while (is_of_word(text[at]) && end < text.size() && is_of_word(text[end])) ++end;
  return end;
}

Tokens split(std::string_view text) {
  Tokens tokens;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view token = text.substr(at, find_end(text, at) - at);
    const bool is_comment = token.substr(0, 2) == "//" || token.substr(0, 2) == "/*";
    if (!is_comment && std::isspace(static_cast<unsigned char>(text[at])) == 0) tokens.push_back(token);
    at += token.size();
  }
  return tokens;
}

std::string_view get(const Tokens& tokens, std::size_t place) {
  return place < tokens.size() ? tokens[place] : std::string_view();
}

// Whether the word at a place begins a statement or a function with an argument, is the file of a mesh size
// field, or the field that a program computes; other options are CATEGORY.Name.
bool begins_statement(const Tokens& tokens, std::size_t place) {
  const std::string_view following = get(tokens, place + 1);
  if (tokens[place] == "FileName" || tokens[place] == "ExternalProcess") return true;
  if (place > 0 && tokens[place - 1] == ".") return false;
  return !following.empty() && (is_quote(following[0]) || begins_word(following[0]) || following == "(");
}

// Whether Printf(…) > "FILE" or >> "FILE" stands at a place.
bool prints_to_file(const Tokens& tokens, std::size_t place) {
  if (tokens[place] != "Printf" || get(tokens, place + 1) != "(") return false;
  int depth = 0;
  for (std::size_t p = place + 1; p < tokens.size(); ++p) {
    depth += tokens[p] == "(" ? 1 : tokens[p] == ")" ? -1 : 0;
    if (depth == 0) return get(tokens, p + 1) == ">";
  }
  return false;
}

GeoStatement locate(std::string_view text, std::string_view word) {
  const auto at = static_cast<std::size_t>(word.data() - text.data());
  const std::string_view before = text.substr(0, at);
  const std::size_t line_begin = before.rfind('\n') + 1;  // 0 where there is none
  return {.word = word,
          .line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1,
          .column = static_cast<int>(at - line_begin) + 1};
}

bool contains(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::optional<GeoStatement> find_geo_statement(std::string_view text,
                                               std::span<const std::string_view> words) {
  const Tokens tokens = split(text);
  for (std::size_t place = 0; place < tokens.size(); ++place) {
    if (contains(words, tokens[place]) && begins_statement(tokens, place)) return locate(text, tokens[place]);
  }
  return std::nullopt;
}

std::optional<GeoStatement> find_dropped_statement(std::string_view text) {
  const std::size_t line_begin = text.rfind('\n') + 1;  // 0 where there is none
  const Tokens tokens = split(text);
  auto token = std::find_if(tokens.begin(), tokens.end(), [&](std::string_view one) {
    return one == ";" && one.data() >= text.data() + line_begin;
  });
  if (token == tokens.end() || ++token == tokens.end()) return std::nullopt;
  return locate(text, *token);
}

std::optional<GeoStatement> find_writing_statement(std::string_view text) {
  static constexpr std::array<std::string_view, 9> kWords = {
      "Save",      "Print",  "System",    "SystemCall",     "NonBlockingSystemCall",
      "OnelabRun", "Plugin", "CreateDir", "ExternalProcess"};
  const Tokens tokens = split(text);
  for (std::size_t place = 0; place < tokens.size(); ++place) {
    const bool writes = contains(kWords, tokens[place]) && begins_statement(tokens, place);
    if (writes || prints_to_file(tokens, place)) return locate(text, tokens[place]);
  }
  return std::nullopt;
}

}  // namespace sprung::fem

#include "reduce/matrices/matrix_market.h"

#include <fmt/format.h>

#include <cctype>
#include <limits>

namespace sprung::reduce {

namespace {

struct Banner {
  bool is_array = false, is_symmetric = false;
};

std::string to_lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// One of two words.
bool read_word(const TextLines& lines, const TextField& field, std::string_view yes, std::string_view no) {
  const std::string word = to_lower(field.text);
  if (word == yes || word == no) return word == yes;
  throw lines.error(field, fmt::format("'{}' is not read, expected '{}' or '{}'", field.text, yes, no));
}

Banner read_banner(TextLines& lines) {
  if (!lines.next()) throw lines.error("is empty, expected a Matrix Market file");
  const std::vector<TextField> fields = lines.fields();
  if (fields.size() != 5 || to_lower(fields[0].text) != "%%matrixmarket" ||
      to_lower(fields[1].text) != "matrix") {
    throw lines.error("does not begin with '%%MatrixMarket matrix FORMAT FIELD SYMMETRY'");
  }
  Banner banner;
  banner.is_array = read_word(lines, fields[2], "array", "coordinate");
  read_word(lines, fields[3], "real", "integer");
  banner.is_symmetric = read_word(lines, fields[4], "symmetric", "general");
  return banner;
}

// Goes to the next line that holds data.
bool next_data(TextLines& lines, std::vector<TextField>& fields, std::size_t expected) {
  do {
    if (!lines.next()) return false;
    fields = lines.fields();
  } while (fields.empty() || fields[0].text.front() == '%');
  if (fields.size() == expected) return true;
  throw lines.error(fmt::format("has {} numbers, expected {}", fields.size(), expected));
}

// Rows, columns and, of `coordinate`, the number of entries.
std::int64_t read_sizes(TextLines& lines, bool is_array, const FreedomList& freedoms) {
  std::vector<TextField> fields;
  if (!next_data(lines, fields, is_array ? 2 : 3)) throw lines.error("ends before the size of the matrix");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::int64_t size = lines.integer(fields[i], 0, std::numeric_limits<std::int32_t>::max());
    if (size != freedoms.size()) {
      throw lines.error(fields[i], fmt::format("the matrix has {} {}, the table of freedoms has {}", size,
                                               i == 0 ? "rows" : "columns", freedoms.size()));
    }
  }
  return is_array ? 0 : lines.integer(fields[2], 0, std::numeric_limits<std::int64_t>::max());
}

std::string describe_end(std::int64_t found, std::int64_t expected) {
  return fmt::format("ends after {} of {} entries", found, expected);
}

void require_end(TextLines& lines, std::int64_t expected) {
  while (lines.next()) {
    if (!lines.fields().empty() && lines.line().front() != '%')
      throw lines.error(fmt::format("stands after the last of {} entries", expected));
  }
}

void read_coordinates(TextLines& lines, const Banner& banner, int size, std::int64_t expected,
                      MatrixEntries& entries) {
  std::vector<TextField> fields;
  for (std::int64_t i = 0; i < expected; ++i) {
    if (!next_data(lines, fields, 3)) throw lines.error(describe_end(i, expected));
    const auto row = static_cast<int>(lines.integer(fields[0], 1, size)) - 1;
    const auto column = static_cast<int>(lines.integer(fields[1], 1, size)) - 1;
    if (banner.is_symmetric && column > row) {
      throw lines.error(fields[1],
                        "stands above the diagonal of a symmetric matrix, of which the file has "
                        "the lower triangle");
    }
    add_entry(lines, row, column, fields[2], entries);
  }
  require_end(lines, expected);
}

void read_array(TextLines& lines, const Banner& banner, int size, MatrixEntries& entries) {
  std::vector<TextField> fields;
  const std::int64_t n = size, expected = banner.is_symmetric ? n * (n + 1) / 2 : n * n;
  std::int64_t found = 0;
  for (int column = 0; column < size; ++column) {
    for (int row = banner.is_symmetric ? column : 0; row < size; ++row, ++found) {
      if (!next_data(lines, fields, 1)) throw lines.error(describe_end(found, expected));
      add_entry(lines, row, column, fields[0], entries);
    }
  }
  require_end(lines, expected);
}

}  // namespace

MatrixEntries read_matrix_market(const std::filesystem::path& path, const FreedomList& freedoms) {
  TextLines lines(path);
  const Banner banner = read_banner(lines);
  const std::int64_t expected = read_sizes(lines, banner.is_array, freedoms);
  MatrixEntries entries{.path = path.string(), .items = {}, .is_full = !banner.is_symmetric};
  if (banner.is_array) {
    read_array(lines, banner, freedoms.size(), entries);
  } else {
    read_coordinates(lines, banner, freedoms.size(), expected, entries);
  }
  return entries;
}

}  // namespace sprung::reduce

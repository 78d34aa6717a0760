#include "reduce/matrices/abaqus_matrix.h"

#include <fmt/format.h>

#include <cctype>
#include <limits>

namespace sprung::reduce {

namespace {

constexpr std::size_t kLabels = 5, kCoordinates = 3;  // numbers in a line of each form

bool is_matrix_input(std::string_view line) {
  constexpr std::string_view kKeyword = "*matrixinput";
  std::string plain;
  for (const char c : line.substr(0, line.find(','))) {
    if (c != ' ' && c != '\t') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain == kKeyword;
}

bool is_data(const TextLines& lines) {
  const std::string_view line = lines.line();
  if (line.starts_with("**") || lines.fields().empty()) return false;
  if (!line.starts_with("*")) return true;
  if (is_matrix_input(line)) return false;
  throw lines.error(fmt::format("'{}' is no part of a matrix, expected *MATRIX INPUT or numbers", line));
}

Freedom read_abaqus_freedom(const TextLines& lines, const TextField& node, const TextField& direction) {
  const std::int64_t id =
      lines.integer(node, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int32_t>::max());
  const auto number = static_cast<int>(lines.integer(direction, 1, 6));
  return make_abaqus_freedom(id, number);
}

}  // namespace

Freedom make_abaqus_freedom(std::int64_t node, int direction) {
  if (node > 0) return {node, direction};
  return {node, direction == 1 ? 0 : -direction};
}

MatrixEntries read_abaqus_matrix(const std::filesystem::path& path, FreedomList& freedoms, bool has_table) {
  TextLines lines(path);
  MatrixEntries entries{.path = path.string(), .items = {}, .is_full = false};
  std::size_t form = 0;
  while (lines.next()) {
    if (!is_data(lines)) continue;
    const std::vector<TextField> fields = lines.fields();
    if (form == 0 && (fields.size() == kLabels || fields.size() == kCoordinates)) form = fields.size();
    if (form == kCoordinates && !has_table) {
      throw lines.error("is of the form row, column, value, which needs a table of the rows: 'freedoms'");
    }
    if (form == 0 || fields.size() != form) {
      throw lines.error(form == 0
                            ? fmt::format("has {} numbers, expected 5 (row node, direction, column node, "
                                          "direction, value) or 3 (row, column, value)",
                                          fields.size())
                            : fmt::format("has {} numbers, expected {}", fields.size(), form));
    }
    if (form == kCoordinates) {
      const auto row = static_cast<int>(lines.integer(fields[0], 1, freedoms.size())) - 1;
      const auto column = static_cast<int>(lines.integer(fields[1], 1, freedoms.size())) - 1;
      add_entry(lines, row, column, fields[2], entries);
    } else {
      const int row = freedoms.get(read_abaqus_freedom(lines, fields[0], fields[1]));
      const int column = freedoms.get(read_abaqus_freedom(lines, fields[2], fields[3]));
      add_entry(lines, row, column, fields[4], entries);
    }
  }
  if (entries.items.empty()) throw lines.error("has no entries");
  return entries;
}

}  // namespace sprung::reduce

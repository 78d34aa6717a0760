#include "reduce/matrices/abaqus_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>
#include <string>

namespace sprung::reduce {

namespace {

constexpr std::size_t kLabels = 5, kCoordinates = 3;  // numbers in a line of each form

// A word in small letters and without blanks: Abaqus passes over these.
std::string make_plain(std::string_view text) {
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isspace(byte) == 0) plain += static_cast<char>(std::tolower(byte));
  }
  return plain;
}

double read_scale_factor(const TextLines& lines, const TextField& field, std::string_view text) {
  const double factor = lines.real({text, field.column});
  if (factor != 0.0) return factor;
  throw lines.error(field, fmt::format("the scale factor is {}, expected another number than 0", text));
}

// The factor of all entries. A parameter that would change them in another way is an error.
double read_matrix_input(const TextLines& lines) {
  double factor = 1.0;
  const std::vector<TextField> parameters = lines.cells();
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    const TextField& field = parameters[i];
    const std::size_t end = std::min(field.text.find('='), field.text.size());
    const std::string name = make_plain(field.text.substr(0, end));
    const std::string value = make_plain(field.text.substr(std::min(end + 1, field.text.size())));
    if (name.empty() || name == "name" || (name == "type" && value == "symmetric")) continue;
    if (name != "scalefactor") {
      throw lines.error(
          field, fmt::format("'{}' is not read, expected NAME, TYPE=SYMMETRIC, SCALE FACTOR", field.text));
    }
    factor = read_scale_factor(lines, field, value);
  }
  return factor;
}

bool is_data(const TextLines& lines) {
  return !lines.line().starts_with("**") && !lines.fields().empty();
}

bool is_matrix_input(const TextLines& lines) {
  const std::string_view line = lines.line();
  if (!line.starts_with("*")) return false;
  if (make_plain(line.substr(0, line.find(','))) == "*matrixinput") return true;
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
  std::optional<double> factor;
  while (lines.next()) {
    if (!is_data(lines)) continue;
    if (is_matrix_input(lines)) {
      if (factor || form != 0) throw lines.error("begins a second matrix, expected one in a file");
      factor = read_matrix_input(lines);
      continue;
    }
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
  for (MatrixEntry& entry : entries.items) entry.value *= factor.value_or(1.0);
  return entries;
}

}  // namespace sprung::reduce

#include "dynamics/measured/column_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dynamics/measured/text_check.h"
#include "tools/support/files/content_hash.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::dynamics {

namespace {

constexpr double kLargestCell = 1e15;  // of a number in any unit

// "front [mm]" and "front (mm)" are the signal front in mm.
Signal split_name(std::string_view text) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t begin = text.rfind(open);
    if (begin == std::string_view::npos || !text.ends_with(close)) continue;
    return {std::string(trim(text.substr(0, begin))),
            std::string(trim(text.substr(begin + 1, text.size() - begin - 2)))};
  }
  return {std::string(text), ""};
}

std::string describe_cell(std::string_view text) {
  if (text.empty()) return "an empty cell";
  const bool has_comma = text.find(',') != std::string_view::npos && text.find('.') == std::string_view::npos;
  return fmt::format("'{}'{}", text, has_comma ? ", which has a decimal comma instead of a point" : "");
}

std::string_view without_brackets(std::string_view unit) {
  const bool has_brackets = unit.size() >= 2 && (unit.front() == '[' || unit.front() == '(');
  return has_brackets ? trim(unit.substr(1, unit.size() - 2)) : unit;
}

}  // namespace

// Gives the lines with cells, one after the other; blank lines and comments have none.
class ColumnFile::Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }
  std::optional<Line> next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      const std::string_view text = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      const std::size_t first = text.find_first_not_of(" \t\r");
      if (first != std::string_view::npos && text[first] != '#') return Line{text, number_};
    }
    return std::nullopt;
  }

 private:
  std::string_view rest_;
  int number_ = 0;
};

ColumnFile ColumnFile::read(const std::filesystem::path& path) {
  ColumnFile file;
  file.path_ = path.string();
  file.text_ = support::read_text_file(path);
  file.hash_ = support::sha256(file.text_);
  check_text(file.text_, file.path_);
  file.read_header();
  return file;
}

// Cells in double quotes may contain separators. A separator at the end of the line adds no cell, unless one
// is missing.
void ColumnFile::split(std::string_view line, std::vector<Cell>& cells) const {
  cells.clear();
  std::size_t at = 0;
  while (true) {
    at = std::min(line.find_first_not_of(separator_ == '\t' ? " \r" : " \t\r", at), line.size());
    if (at == line.size() && !cells.empty()) {
      const bool is_missing = separator_ != ' ' && cells.size() + 1 == columns_.size();
      if (is_missing) cells.push_back({.text = {}, .column = static_cast<int>(at) + 1, .behind = {}});
      return;
    }
    const bool is_quoted = at < line.size() && line[at] == '"';
    const std::size_t begin = is_quoted ? at + 1 : at;
    const std::size_t close = is_quoted ? std::min(line.find('"', begin), line.size()) : at;
    const std::size_t end = std::min(line.find(separator_, close), line.size());
    Cell cell{.text = trim(line.substr(begin, (is_quoted ? close : end) - begin)),
              .column = static_cast<int>(begin) + 1,
              .behind = {}};
    if (is_quoted) cell.behind = close < line.size() ? trim(line.substr(close + 1, end - close - 1)) : "\"";
    cells.push_back(cell);
    if (end == line.size()) return;
    at = end + 1;
  }
}

void ColumnFile::read_header() {
  Lines lines(text_);
  const std::optional<Line> names = lines.next();
  if (!names)
    throw support::InputError({.path = path_}, "is empty; expected a line with the names of columns");
  for (const char separator : {' ', ',', ';', '\t'}) {
    if (names->text.find(separator) != std::string_view::npos) separator_ = separator;
  }
  std::vector<Cell> cells;
  split(names->text, cells);
  for (const Cell& cell : cells) {
    const support::SourceLocation here{path_, names->number, cell.column};
    if (parse_number(cell.text)) {
      throw support::InputError(
          here,
          fmt::format("the first line must have the names of the columns, got the number '{}'", cell.text));
    }
    columns_.push_back(split_name(cell.text));
    if (!cell.behind.empty()) {
      const Signal unit = split_name(cell.behind);
      if (!unit.name.empty() || !columns_.back().unit.empty()) {
        throw support::InputError(here,
                                  fmt::format("expected the end of the cell or a unit in brackets behind "
                                              "the name in quotes, got '{}'",
                                              cell.behind));
      }
      columns_.back() = {std::string(cell.text), unit.unit};
    }
    const std::string& name = columns_.back().name;
    if (name.empty()) throw support::InputError(here, "a column must have a name");
    const auto same = [&](const Signal& other) { return other.name == name; };
    if (std::any_of(columns_.begin(), columns_.end() - 1, same))
      throw support::InputError(here, fmt::format("two columns have the name '{}'", name));
  }
  const std::optional<Line> second = lines.next();
  if (!second) throw support::InputError({.path = path_}, "has no lines below the names of the columns");
  split(second->text, cells);
  if (are_units(cells)) read_units(cells, *second);
}

// Whether cells are units and no numbers; "1" is both, and a unit beside others that are known.
bool ColumnFile::are_units(const std::vector<Cell>& cells) {
  const auto is_number = [](const Cell& cell) { return parse_number(cell.text).has_value(); };
  if (std::none_of(cells.begin(), cells.end(), is_number)) return true;
  return std::any_of(cells.begin(), cells.end(), [&](const Cell& cell) { return !is_number(cell); }) &&
         std::all_of(cells.begin(), cells.end(),
                     [](const Cell& cell) { return find_unit(without_brackets(cell.text)).has_value(); });
}

void ColumnFile::read_units(const std::vector<Cell>& cells, const Line& line) {
  check_number_of_cells(cells, line);
  num_header_lines_ = 2;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view unit = without_brackets(cells[i].text);
    std::string& known = columns_[i].unit;
    if (!known.empty() && known != unit) {
      throw support::InputError(
          {path_, line.number, cells[i].column},
          fmt::format("the column '{}' has the unit '{}' in the line of names, and '{}' here",
                      columns_[i].name, known, unit));
    }
    known = unit;
  }
}

void ColumnFile::check_number_of_cells(const std::vector<Cell>& cells, const Line& line) const {
  if (cells.size() == columns_.size()) return;
  const std::size_t last = std::min(cells.size(), columns_.size() + 1) - 1;
  throw support::InputError({path_, line.number, cells[last].column},
                            fmt::format("the line has {} cells, expected {}, one for each name: {}",
                                        cells.size(), columns_.size(), list_names(columns_)));
}

std::vector<double> ColumnFile::read_column(std::size_t column) const {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(std::count(text_.begin(), text_.end(), '\n')) + 1);
  Lines lines(text_);
  for (std::size_t i = 0; i < num_header_lines_; ++i) lines.next();
  std::vector<Cell> cells;
  while (const std::optional<Line> line = lines.next()) {
    split(line->text, cells);
    check_number_of_cells(cells, *line);
    const Cell& cell = cells[column];
    if (!cell.behind.empty()) {
      throw support::InputError(
          {path_, line->number, cell.column},
          fmt::format("expected the end of the cell behind the number in quotes, got '{}'", cell.behind));
    }
    const std::optional<double> value = parse_number(cell.text);
    if (!value || !(std::abs(*value) <= kLargestCell)) {
      throw support::InputError({path_, line->number, cell.column},
                                fmt::format("'{}' must be a finite number within ±{:g}, got {}",
                                            columns_[column].name, kLargestCell, describe_cell(cell.text)));
    }
    values.push_back(*value);
  }
  if (values.size() >= 2) return values;
  throw support::InputError({.path = path_},
                            fmt::format("must have at least 2 lines of numbers, got {}", values.size()));
}

support::SourceLocation ColumnFile::locate(std::size_t column, std::size_t row) const {
  Lines lines(text_);
  for (std::size_t i = 0; i < num_header_lines_ + row; ++i) lines.next();
  const std::optional<Line> line = lines.next();
  if (!line) return {.path = path_};
  std::vector<Cell> cells;
  split(line->text, cells);
  return {path_, line->number, column < cells.size() ? cells[column].column : 1};
}

}  // namespace sprung::dynamics

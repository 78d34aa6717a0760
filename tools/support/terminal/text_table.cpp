#include "tools/support/terminal/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string_view>

namespace sprung::support {

namespace {

constexpr std::string_view kGap = "  ";

// Columns a text takes on a terminal: its UTF-8 code points, continuation bytes left out.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

bool starts_like_a_number(std::string_view cell) {
  return std::string_view("0123456789+-.").find(cell.front()) != std::string_view::npos ||
         cell.starts_with("−");
}

}  // namespace

TextTable::TextTable(std::vector<std::string> header) {
  rows_.push_back(std::move(header));
}

void TextTable::add_row(std::vector<std::string> cells) {
  if (cells.size() != rows_.front().size()) {
    throw std::invalid_argument(fmt::format("TextTable::add_row: {} cells in a table of {} columns",
                                            cells.size(), rows_.front().size()));
  }
  rows_.push_back(std::move(cells));
}

std::string TextTable::str() const {
  const std::size_t num_columns = rows_.front().size();
  std::vector<std::size_t> widths(num_columns, 0);
  std::vector<bool> numeric(num_columns, false);
  std::size_t total = 0;
  for (std::size_t column = 0; column < num_columns; ++column) {
    bool any = false;
    bool all = true;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const std::string& cell = rows_[row][column];
      widths[column] = std::max(widths[column], width(cell));
      if (row == 0 || cell.empty()) continue;
      any = true;
      all = all && starts_like_a_number(cell);
    }
    numeric[column] = any && all;
    total += widths[column] + (column == 0 ? 0 : kGap.size());
  }

  std::string text;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    std::string line;
    for (std::size_t column = 0; column < num_columns; ++column) {
      const std::string& cell = rows_[row][column];
      const std::string padding(widths[column] - width(cell), ' ');
      if (column > 0) line += kGap;
      line += numeric[column] ? padding + cell : cell + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
    if (row == 0) {
      for (std::size_t i = 0; i < total; ++i) text += "─";
      text += '\n';
    }
  }
  return text;
}

std::string format_fixed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.front() == '-' && text.find_first_of("123456789") == std::string::npos ? text.substr(1) : text;
}

std::string format_count(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace sprung::support

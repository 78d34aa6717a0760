#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/measured/signal.h"
#include "tools/support/errors/input_error.h"

namespace sprung::dynamics {

/// A text file with one column of numbers for each signal (measured, "Text files"). Columns are read one at a
/// time, so that others may hold anything.
/// Checked by tests/dynamics/measured/column_file_test.cpp
class ColumnFile {
 public:
  /// Reads the file and its header.
  /// @throws support::InputError at the place where the header is wrong
  static ColumnFile read(const std::filesystem::path& path);

  std::span<const Signal> columns() const { return columns_; }
  const std::string& hash() const { return hash_; }  ///< SHA-256 of the content

  /// The numbers of a column as written, at least 2.
  /// @param column  0-based
  /// @throws support::InputError at a line with too few or too many cells, and at a cell that is no number
  std::vector<double> read_column(std::size_t column) const;
  /// The place of a cell, for messages.
  support::SourceLocation locate(std::size_t column, std::size_t row) const;

 private:
  // A line, and the position in the text at which it begins.
  struct Line {
    std::string_view text;
    int number = 0;  // 1-based
  };
  class Lines;  // those that hold cells
  struct Cell {
    std::string_view text;
    int column = 0;           // 1-based place in the line
    std::string_view behind;  // the closing quote, up to the separator; of a cell without its end the quote
  };

  ColumnFile() = default;
  void read_header();
  void read_units(const std::vector<Cell>& cells, const Line& line);
  void split(std::string_view line, std::vector<Cell>& cells) const;
  static bool are_units(const std::vector<Cell>& cells);
  void check_number_of_cells(const std::vector<Cell>& cells, const Line& line) const;

  std::string path_, text_, hash_;
  char separator_ = ',';
  std::vector<Signal> columns_;
  std::size_t num_header_lines_ = 1;  // of the lines that hold cells
};

}  // namespace sprung::dynamics

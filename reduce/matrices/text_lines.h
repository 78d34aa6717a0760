#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

/// A part of a line, and the column where it begins.
struct TextField {
  std::string_view text;
  int column = 1;  ///< 1-based, in bytes
};

/// A text file, line by line. Its errors name the place.
class TextLines {
 public:
  /// @throws support::InputError if the file cannot be read
  explicit TextLines(const std::filesystem::path& path);

  /// Goes on to the next line. @return false at the end of the file
  /// @throws support::InputError where the last line has no end: its last number may lack digits
  bool next();
  std::string_view line() const { return line_; }
  int number() const { return number_; }  ///< 1-based
  const std::string& path() const { return path_; }

  /// The parts of the line between blanks, tabs and commas.
  std::vector<TextField> fields() const;
  /// The parts of the line between commas, without the blanks around them; a part may be empty.
  std::vector<TextField> cells() const;

  /// A real number: 1.5, 2e-3, 2D-3, and 1.5-3 as Nastran writes it. Infinity and NaN are errors.
  double real(const TextField& field) const;
  std::int64_t integer(const TextField& field, std::int64_t smallest, std::int64_t largest) const;

  [[nodiscard]] support::InputError error(std::string_view message) const;  ///< at the line
  [[nodiscard]] support::InputError error(const TextField& field, std::string_view message) const;

 private:
  std::string path_, text_;
  std::string_view rest_, line_;
  int number_ = 0;
};

}  // namespace sprung::reduce

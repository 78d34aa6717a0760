#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sprung::support {

/// A table of text: columns are as wide as their widest cell, numbers right-aligned, text left-aligned.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header);
  void add_row(std::vector<std::string> cells);
  /// Lines ending in '\n'; a rule under the header.
  std::string str() const;

 private:
  std::vector<std::vector<std::string>> rows_;  // the first is the header
};

/// A number with this many digits after the point. A number that rounds to zero has no sign.
std::string format_fixed(double value, int digits);
/// "1 mode", "2 modes"
std::string format_count(std::size_t count, std::string_view noun);

}  // namespace sprung::support

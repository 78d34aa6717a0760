#pragma once

#include <string>
#include <vector>

namespace sprung::support {

/// A table for people: columns as wide as their widest cell, numbers right-aligned, text left-aligned.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header);
  void add_row(std::vector<std::string> cells);
  /// Lines ending in '\n'; a rule under the header.
  std::string str() const;

 private:
  std::vector<std::vector<std::string>> rows_;  // the first is the header
};

}  // namespace sprung::support

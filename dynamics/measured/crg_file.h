#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/errors/input_error.h"

namespace sprung::dynamics {

/// A straight road surface in the text form of OpenCRG: heights along sections that are parallel to the
/// reference line (measured, "OpenCRG").
/// Checked by tests/dynamics/measured/crg_file_test.cpp
class CrgFile {
 public:
  /// @throws support::InputError at the place where the file is wrong, or holds what is not read here: binary
  ///         data, a reference line that turns, climbs or is banked
  static CrgFile read(const std::filesystem::path& path);

  double increment() const { return increment_; }         ///< distance between points along the road, > 0 [m]
  double rightmost() const { return sections_.front(); }  ///< lateral position, left is positive [m]
  double leftmost() const { return sections_.back(); }

  /// Heights along a line at a lateral position, linear between the two sections beside it [m].
  /// @param lateral  from rightmost() to leftmost() [m]
  /// @throws support::InputError at a missing height
  std::vector<double> read_heights(double lateral) const;

 private:
  enum class Block { kOther, kParameters, kChannels };
  struct Line {
    std::string_view text;
    int number = 0;  // 1-based
  };
  struct Parameter {
    double value = 0.0;
    support::SourceLocation location;
  };
  struct Channel {
    bool is_section = false;
    double place = 0.0;  // number of a section, or its lateral position [m]
    bool is_numbered = false;
    support::SourceLocation location;
  };

  CrgFile() = default;
  void split_lines();
  void read_header();
  Block enter_block(const Line& line) const;
  void read_parameter(const Line& line, std::string_view text);
  void read_channel(const Line& line, std::string_view text);
  void check_straight() const;
  void place_sections();
  void check_last_section() const;
  void count_rows();
  void check_fields() const;
  double parameter_or(const std::string& name, double fallback) const;
  // The field of a channel in a row of data, and its place.
  std::string_view field(std::size_t row, std::size_t channel, support::SourceLocation& place) const;
  double read_field(std::size_t row, std::size_t channel) const;

  std::string path_, text_;
  std::vector<Line> lines_;
  std::map<std::string, Parameter, std::less<>> parameters_;
  std::vector<Channel> channels_;
  std::vector<double> sections_;              // lateral positions, ascending [m]
  std::vector<std::size_t> section_columns_;  // their channels
  std::size_t width_ = 0;                     // of a field; 0 while unknown
  std::size_t data_begin_ = 0;                // the first of the lines with data
  std::size_t fields_of_line_ = 1, lines_of_row_ = 1, num_rows_ = 0;
  double increment_ = 0.0;
};

}  // namespace sprung::dynamics

#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dynamics/functions/time_function.h"
#include "dynamics/measured/column_file.h"
#include "dynamics/measured/rpc3_file.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// The use of a function of time, which determines how points are interpolated.
enum class TimeFunctionUse {
  kForce,   ///< straight lines between the points of a table
  kMotion,  ///< a curve through them that has a velocity and an acceleration
};

/// A measured history, as a function of time of the vehicle uses it.
struct HistoryUse {
  std::string key;  ///< full key in the vehicle file
  support::SourceLocation location;
  std::string file;       ///< as the vehicle file names it
  std::string channel;    ///< name in the file
  std::string unit;       ///< the samples are taken to be in this unit; "" for SI
  std::string file_unit;  ///< the unit that the file gives; "" if none
  std::string si_unit;    ///< the SI unit of that one; "" if the unit is not known
  std::string hash;       ///< SHA-256 of the file
  std::string interpolation;
  double scale = 1.0, offset = 0.0;
  double from = 0.0, to = 0.0;  ///< of the run, at the first and the last sample [s]
  double needed_from = 0.0;     ///< it counts from this time of the run on [s]
  double needed_to = std::numeric_limits<double>::infinity();  ///< until this one [s]
  double shortest_spacing = 0.0, mean_spacing = 0.0;           ///< of the samples [s]
  double swing = 0.0;         ///< of a smooth curve beyond the range of the samples, as a share of that range
  std::string before, after;  ///< what holds outside: "hold" or a number; "" if nothing does
};

/// Reads measured histories, each file once.
/// Checked by tests/dynamics/element_input/history_input_test.cpp
class HistoryFiles {
 public:
  /// @param folder  that the files are relative to
  explicit HistoryFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Reads the table of a `history`.
  /// @param unit  of the function's value
  /// @throws support::InputError for a key that is missing, unknown or has a bad value, and for a file that
  ///         cannot be used
  TimeFunction read(const support::TomlTable& table, std::string_view unit, TimeFunctionUse use);

  /// The histories that have been read.
  const std::vector<HistoryUse>& used() const { return used_; }
  /// Those from number `first` on count between two times only, as part of a function in pieces.
  void limit(std::size_t first, double from, double to);

 private:
  using File = std::variant<ColumnFile, Rpc3File>;
  const File& open(const support::TomlValue& file);

  std::filesystem::path folder_;
  std::map<std::string, std::unique_ptr<File>> files_;  // by path
  std::vector<HistoryUse> used_;
};

/// Checks that each history says what holds at all times of a run.
/// @param to  the end of the run, ≥ 0 [s]
/// @throws support::InputError at the first one that does not
void check_histories(std::span<const HistoryUse> histories, double to);

/// A text for each history that a run exceeds, for each smooth one with samples much closer than the others,
/// which shorten steps, and for each smooth one that swings far beyond its samples.
std::vector<std::string> list_history_remarks(std::span<const HistoryUse> histories, double to);

}  // namespace sprung::dynamics

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/measured/signal.h"

namespace sprung::dynamics {

/// A time history in the binary format RPC III (measured, "RPC III").
/// Checked by tests/dynamics/measured/rpc3_file_test.cpp
class Rpc3File {
 public:
  /// Whether a file begins as one of this format.
  static bool is_one(const std::filesystem::path& path);
  /// Reads the file and its header.
  /// @throws support::InputError that names the byte at which the file is wrong
  static Rpc3File read(const std::filesystem::path& path);

  /// The description of each channel; without one, CHAN_1, CHAN_2, …
  std::span<const Signal> channels() const { return channels_; }
  double time_step() const { return time_step_; }  ///< > 0 [s]
  std::size_t num_samples() const { return num_samples_; }
  const std::string& hash() const { return hash_; }  ///< SHA-256 of the content

  /// The samples of a channel in its unit.
  /// @param channel  0-based
  /// @throws support::InputError at a sample that is not finite
  std::vector<double> read_channel(std::size_t channel) const;

 private:
  enum class SampleType { kShortInteger, kFloatingPoint };
  struct Value {
    std::string text;
    std::size_t byte = 0;  // of the file, at which it begins
  };

  Rpc3File() = default;
  [[noreturn]] void fail(std::size_t byte, std::string_view message) const;
  void read_records();
  void read_layout();
  void read_channels();
  void check_size();
  const Value* find(const std::string& key) const;
  const Value& at(const std::string& key) const;
  std::int64_t read_integer(const std::string& key, std::int64_t minimum, std::int64_t maximum) const;
  double read_positive(const std::string& key) const;
  void refuse_unless(const std::string& key, std::string_view only, std::string_view why) const;
  double read_sample(std::size_t byte) const;

  std::string path_, content_, hash_;
  std::map<std::string, Value> values_;
  bool is_big_endian_ = false;
  SampleType type_ = SampleType::kShortInteger;
  std::size_t data_begin_ = 0, num_samples_ = 0, group_size_ = 0, last_group_size_ = 0;  // sizes in samples
  double time_step_ = 0.0;
  std::vector<Signal> channels_;
  std::vector<double> scales_;
};

}  // namespace sprung::dynamics

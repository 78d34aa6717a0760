#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sprung::test {

/// A time history to be written in the format RPC III.
struct Rpc3History {
  bool big_endian = false;
  bool floating_point = false;
  bool fills_last_group = true;
  std::size_t frame = 4, group = 8;          // samples of each channel
  double time_step = 0.01;                   // s
  std::vector<double> scales;                // one for each channel; not used with floating-point numbers
  std::vector<std::vector<double>> samples;  // stored numbers of each channel, whole frames
  std::vector<std::pair<std::string, std::string>> changes = {};  // values of the header; "" removes a key
};

/// The bytes of the file: records of 128 bytes, four in a block, then the samples group by group.
std::string format_rpc3(const Rpc3History& history);

/// Writes bytes to a file in the working folder.
void write_file(const std::filesystem::path& path, const std::string& bytes);

}  // namespace sprung::test

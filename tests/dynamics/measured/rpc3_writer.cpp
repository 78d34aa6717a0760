#include "tests/dynamics/measured/rpc3_writer.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace sprung::test {

namespace {

void append_number(const Rpc3History& history, double value, std::string& bytes) {
  std::uint32_t bits = 0;
  if (history.floating_point) {
    const auto number = static_cast<float>(value);
    std::memcpy(&bits, &number, sizeof bits);
  } else {
    bits = static_cast<std::uint16_t>(static_cast<std::int16_t>(value));
  }
  const int size = history.floating_point ? 4 : 2;
  for (int k = 0; k < size; ++k) {
    const int shift = 8 * (history.big_endian ? size - 1 - k : k);
    bytes.push_back(static_cast<char>(bits >> shift & 0xFFU));
  }
}

using Records = std::vector<std::pair<std::string, std::string>>;

Records make_records(const Rpc3History& history) {
  const std::size_t channels = history.samples.size();
  const std::size_t frames = history.samples.front().size() / history.frame;
  Records records{{"FORMAT", history.big_endian ? "BINARY_IEEE_BIG_END" : "BINARY_IEEE_LITTLE_END"},
                  {"NUM_HEADER_BLOCKS", ""},
                  {"NUM_PARAMS", ""},
                  {"FILE_TYPE", "TIME_HISTORY"},
                  {"DATA_TYPE", history.floating_point ? "FLOATING_POINT" : "SHORT_INTEGER"},
                  {"DELTA_T", std::to_string(history.time_step)},
                  {"CHANNELS", std::to_string(channels)},
                  {"PTS_PER_FRAME", std::to_string(history.frame)},
                  {"PTS_PER_GROUP", std::to_string(history.group)},
                  {"FRAMES", std::to_string(frames)},
                  {"PARTITIONS", "1"},
                  {"INT_FULL_SCALE", "32768"}};
  for (std::size_t i = 0; i < channels; ++i) {
    const std::string ending = ".CHAN_" + std::to_string(i + 1);
    records.push_back({"DESC" + ending, "post " + std::to_string(i + 1)});
    records.push_back({"UNITS" + ending, "mm"});
    records.push_back(
        {"SCALE" + ending, std::to_string(i < history.scales.size() ? history.scales[i] : 1.0)});
  }
  for (const auto& [key, value] : history.changes) {
    const auto found =
        std::find_if(records.begin(), records.end(), [&](const auto& one) { return one.first == key; });
    if (found == records.end())
      records.push_back({key, value});
    else if (value.empty())
      records.erase(found);
    else
      found->second = value;
  }
  return records;
}

}  // namespace

std::string format_rpc3(const Rpc3History& history) {
  Records records = make_records(history);
  const std::size_t blocks = (records.size() + 3) / 4;
  for (auto& [key, value] : records) {
    if (!value.empty()) continue;
    if (key == "NUM_HEADER_BLOCKS") value = std::to_string(blocks);
    if (key == "NUM_PARAMS") value = std::to_string(records.size());
  }
  std::string bytes(512 * blocks, '\0');
  for (std::size_t i = 0; i < records.size(); ++i) {
    bytes.replace(128 * i, records[i].first.size(), records[i].first);
    bytes.replace(128 * i + 32, records[i].second.size(), records[i].second);
  }
  const std::size_t samples = history.samples.front().size();
  for (std::size_t begin = 0; begin < samples; begin += history.group) {
    for (const std::vector<double>& channel : history.samples) {
      for (std::size_t k = begin; k < begin + history.group; ++k) {
        if (k < samples)
          append_number(history, channel[k], bytes);
        else if (history.fills_last_group)
          append_number(history, 0.0, bytes);
      }
    }
  }
  return bytes;
}

void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace sprung::test

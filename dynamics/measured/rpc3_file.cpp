#include "dynamics/measured/rpc3_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <fstream>

#include "tools/support/errors/input_error.h"
#include "tools/support/files/content_hash.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::dynamics {

namespace {

// A record is a key and a value, both filled up with zeros; four of them are a block.
constexpr std::size_t kRecord = 128, kKey = 32, kBlock = 512;
constexpr std::array<std::string_view, 3> kFirstKeys{"FORMAT", "NUM_HEADER_BLOCKS", "NUM_PARAMS"};
constexpr std::int64_t kMostBlocks = 1'000'000, kMostChannels = 10'000, kMostPoints = 1'000'000'000;
constexpr double kLongestStep = 1e6;  // s
constexpr double kStandardFullScale = 32768.0;

std::string_view take_text(std::string_view field) {
  return trim(field.substr(0, field.find('\0')));
}

}  // namespace

bool Rpc3File::is_one(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, kKey> key{};
  stream.read(key.data(), kKey);
  const std::string_view begin(key.data(), static_cast<std::size_t>(stream.gcount()));
  return begin.size() == kKey && take_text(begin) == kFirstKeys[0] && begin.find('\0') != begin.npos;
}

Rpc3File Rpc3File::read(const std::filesystem::path& path) {
  Rpc3File file;
  file.path_ = path.string();
  file.content_ = support::read_text_file(path);
  file.hash_ = support::sha256(file.content_);
  file.read_records();
  file.read_layout();
  file.read_channels();
  file.check_size();
  return file;
}

void Rpc3File::fail(std::size_t byte, std::string_view message) const {
  throw support::InputError({.path = path_}, fmt::format("byte {}: {}", byte, message));
}

// The first three records come in a fixed order; the third says how many there are.
void Rpc3File::read_records() {
  std::size_t count = kFirstKeys.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t byte = i * kRecord;
    if (content_.size() < byte + kRecord) {
      fail(content_.size(),
           fmt::format("the file ends within record {} of the header, of {} bytes", i + 1, kRecord));
    }
    const std::string_view record = std::string_view(content_).substr(byte, kRecord);
    const std::string key(take_text(record.substr(0, kKey)));
    if (i < kFirstKeys.size() && key != kFirstKeys[i]) {
      fail(byte, fmt::format("record {} of the header must be '{}', got '{}'", i + 1, kFirstKeys[i], key));
    }
    if (key.empty()) continue;
    const bool is_new =
        values_.emplace(key, Value{std::string(take_text(record.substr(kKey))), byte + kKey}).second;
    if (!is_new) fail(byte, fmt::format("the header has '{}' twice", key));
    if (i + 1 < kFirstKeys.size()) continue;
    if (i + 1 == kFirstKeys.size())
      count = static_cast<std::size_t>(read_integer("NUM_PARAMS", 3, 4 * kMostBlocks));
  }
  data_begin_ = kBlock * static_cast<std::size_t>(read_integer("NUM_HEADER_BLOCKS", 1, kMostBlocks));
  if (data_begin_ < count * kRecord) {
    fail(at("NUM_HEADER_BLOCKS").byte,
         fmt::format("'NUM_HEADER_BLOCKS' are {} bytes, too few for {} records", data_begin_, count));
  }
}

const Rpc3File::Value* Rpc3File::find(const std::string& key) const {
  const auto found = values_.find(key);
  return found == values_.end() ? nullptr : &found->second;
}

const Rpc3File::Value& Rpc3File::at(const std::string& key) const {
  const Value* value = find(key);
  if (value == nullptr)
    throw support::InputError({.path = path_}, fmt::format("the header has no '{}'", key));
  return *value;
}

std::int64_t Rpc3File::read_integer(const std::string& key, std::int64_t minimum,
                                    std::int64_t maximum) const {
  const Value& value = at(key);
  std::int64_t number = 0;
  const char* end = value.text.data() + value.text.size();
  const auto [stop, error] = std::from_chars(value.text.data(), end, number);
  if (error != std::errc() || stop != end || number < minimum || number > maximum) {
    fail(value.byte, fmt::format("'{}' must be a whole number from {} to {}, got '{}'", key, minimum, maximum,
                                 value.text));
  }
  return number;
}

double Rpc3File::read_positive(const std::string& key) const {
  const Value& value = at(key);
  const std::optional<double> number = parse_number(value.text);
  if (!number || !(*number > 0.0)) {
    fail(value.byte, fmt::format("'{}' must be a number > 0, got '{}'", key, value.text));
  }
  return *number;
}

// Refuses what is not read here: a key that is present must have the one value.
void Rpc3File::refuse_unless(const std::string& key, std::string_view only, std::string_view why) const {
  const Value* value = find(key);
  if (value == nullptr || value->text == only) return;
  fail(value->byte, fmt::format("'{}' must be {}, got '{}': {}", key, only, value->text, why));
}

void Rpc3File::read_layout() {
  const Value& format = at("FORMAT");
  is_big_endian_ = format.text == "BINARY_IEEE_BIG_END";
  if (!is_big_endian_ && format.text != "BINARY_IEEE_LITTLE_END" && format.text != "BINARY") {
    fail(format.byte,
         fmt::format("'FORMAT' must be BINARY_IEEE_LITTLE_END, BINARY_IEEE_BIG_END or BINARY, got '{}'",
                     format.text));
  }
  refuse_unless("FILE_TYPE", "TIME_HISTORY", "only time histories are read");
  refuse_unless("PARTITIONS", "1", "files in several partitions are not read");
  refuse_unless("HALF_FRAMES", "0", "frames that overlap are not read");
  if (const Value* type = find("DATA_TYPE"); type != nullptr) {
    if (type->text == "FLOATING_POINT") {
      type_ = SampleType::kFloatingPoint;
    } else if (type->text != "SHORT_INTEGER") {
      fail(type->byte,
           fmt::format("'DATA_TYPE' must be SHORT_INTEGER or FLOATING_POINT, got '{}'", type->text));
    }
  }
  if (type_ == SampleType::kFloatingPoint && format.text == "BINARY") {
    fail(format.byte,
         "'FORMAT' BINARY does not say how floating-point numbers are stored, "
         "expected BINARY_IEEE_LITTLE_END or BINARY_IEEE_BIG_END");
  }
  time_step_ = read_positive("DELTA_T");
  if (time_step_ > kLongestStep) {
    fail(at("DELTA_T").byte,
         fmt::format("'DELTA_T' must be at most {:g} s, got '{}'", kLongestStep, at("DELTA_T").text));
  }
  const auto frame = static_cast<std::size_t>(read_integer("PTS_PER_FRAME", 1, kMostPoints));
  group_size_ = static_cast<std::size_t>(read_integer("PTS_PER_GROUP", 1, kMostPoints));
  if (group_size_ % frame != 0) {
    fail(at("PTS_PER_GROUP").byte,
         fmt::format("'PTS_PER_GROUP' must be a multiple of the {} 'PTS_PER_FRAME', got {}", frame,
                     group_size_));
  }
  const auto most = kMostPoints / static_cast<std::int64_t>(frame);
  num_samples_ = frame * static_cast<std::size_t>(read_integer("FRAMES", 1, most));
}

void Rpc3File::read_channels() {
  const auto count = static_cast<std::size_t>(read_integer("CHANNELS", 1, kMostChannels));
  const double full_scale =
      find("INT_FULL_SCALE") != nullptr ? read_positive("INT_FULL_SCALE") : kStandardFullScale;
  for (std::size_t i = 1; i <= count; ++i) {
    const std::string ending = fmt::format("CHAN_{}", i);
    const Value* name = find("DESC." + ending);
    const Value* unit = find("UNITS." + ending);
    channels_.push_back(
        {name == nullptr || name->text.empty() ? ending : name->text, unit == nullptr ? "" : unit->text});
    double scale = 1.0;  // numbers in floating point are in the channel's unit already
    if (type_ == SampleType::kShortInteger) {
      const Value& text = at("SCALE." + ending);
      const std::optional<double> number = parse_number(text.text);
      if (!number || *number == 0.0)
        fail(text.byte, fmt::format("'SCALE.{}' must be a number other than 0, got '{}'", ending, text.text));
      scale = *number * full_scale / kStandardFullScale;
    }
    scales_.push_back(scale);
  }
}

// The last group is filled up, or is as short as what is left; the size of the file says which.
void Rpc3File::check_size() {
  const std::size_t bytes = (type_ == SampleType::kShortInteger ? 2 : 4) * channels_.size();
  const std::size_t num_groups = (num_samples_ + group_size_ - 1) / group_size_;
  const std::size_t left = num_samples_ - (num_groups - 1) * group_size_;
  const std::size_t filled = data_begin_ + num_groups * group_size_ * bytes;
  const std::size_t unfilled = data_begin_ + num_samples_ * bytes;
  if (content_.size() < unfilled || (content_.size() > unfilled && content_.size() < filled)) {
    fail(content_.size(),
         fmt::format("the file ends here; its header says {} bytes{}", unfilled,
                     unfilled == filled ? "" : fmt::format(", or {} with a full last group", filled)));
  }
  if (content_.size() >= filled + kBlock) {
    fail(filled,
         fmt::format("the data end here, but the file has {} bytes: 'DATA_TYPE', 'CHANNELS' or 'FRAMES' is "
                     "wrong",
                     content_.size()));
  }
  last_group_size_ = content_.size() < filled ? left : group_size_;
}

double Rpc3File::read_sample(std::size_t byte) const {
  std::uint32_t bits = 0;
  const std::size_t size = type_ == SampleType::kShortInteger ? 2 : 4;
  for (std::size_t k = 0; k < size; ++k) {
    const std::size_t place = is_big_endian_ ? k : size - 1 - k;
    bits = bits << 8 | static_cast<unsigned char>(content_[byte + place]);
  }
  if (type_ == SampleType::kFloatingPoint) return static_cast<double>(std::bit_cast<float>(bits));
  return static_cast<double>(static_cast<std::int16_t>(bits));
}

std::vector<double> Rpc3File::read_channel(std::size_t channel) const {
  const std::size_t size = type_ == SampleType::kShortInteger ? 2 : 4;
  std::vector<double> samples;
  samples.reserve(num_samples_);
  std::size_t group_begin = data_begin_;
  while (samples.size() < num_samples_) {
    const std::size_t left = num_samples_ - samples.size();
    const std::size_t stored = left > group_size_ ? group_size_ : last_group_size_;  // of each channel
    for (std::size_t k = 0; k < std::min(left, stored); ++k) {
      const std::size_t byte = group_begin + (channel * stored + k) * size;
      const double sample = scales_[channel] * read_sample(byte);
      if (!std::isfinite(sample)) {
        fail(byte, fmt::format("sample {} of '{}' is not a finite number", samples.size() + 1,
                               channels_[channel].name));
      }
      samples.push_back(sample);
    }
    group_begin += channels_.size() * stored * size;
  }
  return samples;
}

}  // namespace sprung::dynamics

#include "dynamics/measured/crg_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "dynamics/measured/signal.h"
#include "dynamics/measured/text_check.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::dynamics {

namespace {

constexpr std::size_t kRecordLength = 80;  // of a line of data
constexpr double kSameHeading = 1e-6;      // rad
constexpr double kSameSection = 0.01;      // of the distance of sections
constexpr double kLargestNumber = 1e9;     // m, rad
constexpr double kSamePlace = 1e-6;        // of the increment, or m

std::string to_upper(std::string_view text) {
  std::string upper(text);
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return upper;
}

int place_of(std::string_view part, std::string_view line) {
  return static_cast<int>(part.data() - line.data()) + 1;
}

}  // namespace

CrgFile CrgFile::read(const std::filesystem::path& path) {
  CrgFile file;
  file.path_ = path.string();
  file.text_ = support::read_text_file(path);
  file.split_lines();
  file.read_header();
  check_text(file.text_, file.path_, file.lines_[file.data_begin_ - 1].number);
  file.place_sections();
  file.check_last_section();
  file.count_rows();
  file.check_fields();
  file.check_straight();
  return file;
}

void CrgFile::split_lines() {
  const std::string_view text = text_;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines_.push_back({line, static_cast<int>(lines_.size()) + 1});
    begin = end + 1;
  }
  while (!lines_.empty() && trim(lines_.back().text).empty()) lines_.pop_back();
}

// Blocks begin with $ and a name. The data begin after $$$$.
void CrgFile::read_header() {
  Block block = Block::kOther;
  for (std::size_t i = 0; i < lines_.size() && data_begin_ == 0; ++i) {
    const Line& line = lines_[i];
    if (line.text.starts_with("$$$$")) data_begin_ = i + 1;
    if (line.text.starts_with('$')) block = enter_block(line);
    if (line.text.starts_with('$') || line.text.starts_with('*')) continue;
    const std::string_view text = trim(line.text.substr(0, line.text.find('!')));
    if (text.empty()) continue;
    if (block == Block::kParameters) read_parameter(line, text);
    if (block == Block::kChannels) read_channel(line, text);
  }
  if (data_begin_ == 0) {
    throw support::InputError({.path = path_},
                              "has no line '$$$$', which begins the data of an OpenCRG file");
  }
  if (width_ == 0) {
    throw support::InputError(
        {.path = path_}, "has no format '#:LRFI' or '#:LDFI', so its data are binary; only text is read");
  }
}

CrgFile::Block CrgFile::enter_block(const Line& line) const {
  const std::string_view rest = line.text.substr(1);
  const std::string name = to_upper(rest.substr(0, rest.find_first_of(" \t!")));
  if (name == "ROAD_CRG") return Block::kParameters;
  if (name == "KD_DEFINITION") return Block::kChannels;
  if (name == "ROAD_CRG_MODS" || name == "ROAD_CRG_FILE") {
    throw support::InputError(
        {path_, line.number, 1},
        fmt::format("the block '${}' is not read: it changes the data, or names another file", name));
  }
  return Block::kOther;
}

void CrgFile::read_parameter(const Line& line, std::string_view text) {
  const std::size_t sign = text.find('=');
  const std::string name = to_upper(trim(text.substr(0, sign)));
  const support::SourceLocation here{path_, line.number, place_of(text, line.text)};
  if (sign == std::string_view::npos) throw support::InputError(here, "expected 'PARAMETER = value'");
  if (!name.starts_with("REFERENCE_LINE_") && !name.starts_with("LONG_SECTION_"))
    throw support::InputError(here, fmt::format("'{}' is no parameter of a road", name));
  const std::string_view value = trim(text.substr(sign + 1));
  const std::optional<double> number = parse_number(value);
  if (!number) throw support::InputError(here, fmt::format("'{}' must be a number, got '{}'", name, value));
  parameters_[name] = {*number, here};
  const bool is_positive = name == "REFERENCE_LINE_INCREMENT" || name == "LONG_SECTION_V_INCREMENT";
  if (is_positive && !(*number > 0.0))
    throw support::InputError(here, fmt::format("'{}' must be > 0 m, got {}", name, *number));
  for (const std::string_view level : {"START_S", "END_S", "START_B", "END_B"}) {
    if (name == fmt::format("REFERENCE_LINE_{}", level) && *number != 0.0) {
      throw support::InputError(
          here, fmt::format("'{}' must be 0, got {}: a road that climbs or is banked along its "
                            "reference line is not read",
                            name, *number));
    }
  }
}

void CrgFile::read_channel(const Line& line, std::string_view text) {
  const support::SourceLocation here{path_, line.number, place_of(text, line.text)};
  if (text.starts_with("U:")) return;  // computed from others
  if (text.starts_with("#:")) {
    const std::string format = to_upper(trim(text.substr(2)));
    width_ = format == "LRFI" ? 10 : format == "LDFI" ? 20 : 0;
    if (width_ > 0) return;
    throw support::InputError(
        here, fmt::format("the format must be LRFI or LDFI, which are text, got '{}'", format));
  }
  constexpr std::string_view kSection = "D:long section", kAt = "at v =";
  Channel channel{.location = here};
  if (text.starts_with(kSection)) {
    channel.is_section = true;
    std::string_view place = trim(text.substr(kSection.size()));
    const std::size_t comma = place.find(',');
    const bool is_in_m = comma != std::string_view::npos && trim(place.substr(comma + 1)) == "m";
    place = trim(place.substr(0, comma));
    channel.is_numbered = !place.starts_with(kAt);
    if (!channel.is_numbered) place = trim(place.substr(kAt.size()));
    const std::optional<double> number = parse_number(place);
    if (!number || !is_in_m) {
      throw support::InputError(
          here,
          fmt::format("expected 'D:long section NUMBER,m' or 'D:long section at v = POSITION,m', got '{}'",
                      text));
    }
    channel.place = *number;
  } else if (!text.starts_with("D:reference line phi")) {
    throw support::InputError(
        here, fmt::format("'{}' is not read, only long sections and 'reference line phi'", text));
  }
  channels_.push_back(channel);
}

double CrgFile::parameter_or(const std::string& name, double fallback) const {
  const auto found = parameters_.find(name);
  return found == parameters_.end() ? fallback : found->second.value;
}

// Sections are numbered from right to left. Without the position of either border they lie about the middle.
void CrgFile::place_sections() {
  const auto count = static_cast<double>(
      std::count_if(channels_.begin(), channels_.end(), [](const Channel& c) { return c.is_section; }));
  increment_ = parameter_or("REFERENCE_LINE_INCREMENT", 0.0);
  if (count == 0.0 || increment_ == 0.0) {
    throw support::InputError({.path = path_}, count == 0.0 ? "has no channel 'D:long section'"
                                                            : "has no 'REFERENCE_LINE_INCREMENT'");
  }
  const double right = parameter_or("LONG_SECTION_V_RIGHT", NAN),
               left = parameter_or("LONG_SECTION_V_LEFT", NAN);
  double step = parameter_or("LONG_SECTION_V_INCREMENT", NAN);
  if (std::isnan(step) && count > 1.0) step = (left - right) / (count - 1.0);
  if (count == 1.0) step = 0.0;
  double first = right;
  if (std::isnan(first)) first = std::isnan(left) ? -0.5 * step * (count - 1.0) : left - step * (count - 1.0);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const Channel& channel = channels_[i];
    if (!channel.is_section) continue;
    const double number = static_cast<double>(sections_.size()) + 1.0;
    const double place = channel.is_numbered ? first + step * (number - 1.0) : channel.place;
    const bool is_next = !channel.is_numbered || channel.place == number;
    if (!std::isfinite(place) || !is_next || (!sections_.empty() && !(place > sections_.back()))) {
      throw support::InputError(
          channel.location,
          "sections must be numbered 1, 2, … or have positions, from right to left; numbers need "
          "'LONG_SECTION_V_INCREMENT', or '_V_RIGHT' and '_V_LEFT'");
    }
    sections_.push_back(place);
    section_columns_.push_back(i);
  }
}

// Both borders and the distance may be given; then they must say the same.
void CrgFile::check_last_section() const {
  const double left = parameter_or("LONG_SECTION_V_LEFT", NAN),
               right = parameter_or("LONG_SECTION_V_RIGHT", NAN),
               step = parameter_or("LONG_SECTION_V_INCREMENT", NAN);
  const Channel& last = channels_[section_columns_.back()];
  const double error = std::abs(sections_.back() - left);
  if (!last.is_numbered || sections_.size() < 2 || std::isnan(right + left + step)) return;
  if (error <= kSameSection * step) return;
  throw support::InputError(
      parameters_.at("LONG_SECTION_V_INCREMENT").location,
      fmt::format(
          "'LONG_SECTION_V_INCREMENT' puts section {} at {:.9g} m, but 'LONG_SECTION_V_LEFT' is {:.9g} m",
          sections_.size(), sections_.back(), left));
}

// Each row begins a new line; fields that do not fit continue on further lines.
void CrgFile::count_rows() {
  fields_of_line_ = kRecordLength / width_;
  lines_of_row_ = (channels_.size() + fields_of_line_ - 1) / fields_of_line_;
  const std::size_t count = lines_.size() - data_begin_;
  num_rows_ = count / lines_of_row_;
  if (num_rows_ < 2 || num_rows_ * lines_of_row_ != count) {
    throw support::InputError(
        {.path = path_},
        fmt::format("must have at least 2 rows of data, {} lines each for {} channels; got {} lines",
                    lines_of_row_, channels_.size(), count));
  }
  const double length =
      parameter_or("REFERENCE_LINE_END_U", NAN) - parameter_or("REFERENCE_LINE_START_U", 0.0);
  const double expected = length / increment_ + 1.0;
  if (!std::isnan(expected) && std::abs(expected - static_cast<double>(num_rows_)) > kSamePlace * expected) {
    throw support::InputError(
        {.path = path_},
        fmt::format("has {} rows of data, but 'REFERENCE_LINE_END_U' and '_INCREMENT' say {:.9g}", num_rows_,
                    expected));
  }
}

// A field that is cut off would be another number, and one more would belong to a channel without a name.
void CrgFile::check_fields() const {
  for (std::size_t i = data_begin_; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    const std::size_t first = (i - data_begin_) % lines_of_row_ * fields_of_line_;
    const std::size_t count = std::min(fields_of_line_, channels_.size() - first);
    const std::size_t end = count * width_;
    if (line.text.size() == end || (line.text.size() > end && trim(line.text.substr(end)).empty())) continue;
    throw support::InputError({path_, line.number, static_cast<int>(std::min(line.text.size(), end)) + 1},
                              fmt::format("the line must have {} fields of {} places, got {} places", count,
                                          width_, line.text.size()));
  }
}

std::string_view CrgFile::field(std::size_t row, std::size_t channel, support::SourceLocation& place) const {
  const Line& line = lines_[data_begin_ + row * lines_of_row_ + channel / fields_of_line_];
  const std::size_t begin = channel % fields_of_line_ * width_;
  place = {path_, line.number, static_cast<int>(begin) + 1};
  return begin < line.text.size() ? trim(line.text.substr(begin, width_)) : std::string_view();
}

double CrgFile::read_field(std::size_t row, std::size_t channel) const {
  support::SourceLocation place;
  const std::string_view text = field(row, channel, place);
  const std::optional<double> number = parse_number(text);
  if (number && std::abs(*number) > kLargestNumber) {
    throw support::InputError(place,
                              fmt::format("numbers must be within ±{:g}, got {}", kLargestNumber, text));
  }
  if (number) return *number;
  throw support::InputError(
      place, fmt::format("a number must stand here, in a field of {} places, got '{}'", width_, text));
}

// Neither the height nor the heading of the reference line may change. The heading of the first point belongs
// to no interval.
void CrgFile::check_straight() const {
  const double low = parameter_or("REFERENCE_LINE_START_Z", NAN);
  const double high = parameter_or("REFERENCE_LINE_END_Z", low);
  if (low != high && !std::isnan(low)) {
    throw support::InputError(
        parameters_.at("REFERENCE_LINE_END_Z").location,
        fmt::format(
            "'REFERENCE_LINE_END_Z' must be {}, as at the start, got {}: a road that climbs along its "
            "reference line is not read",
            low, high));
  }
  const double start = parameter_or("REFERENCE_LINE_START_PHI", NAN);
  double heading = start, end = parameter_or("REFERENCE_LINE_END_PHI", start);
  const auto turns = [](double a, double b) { return std::abs(a - b) > kSameHeading; };
  if (turns(start, end)) {
    throw support::InputError(
        {.path = path_},
        fmt::format("turns from {} to {} rad along its reference line; only straight roads are read", start,
                    end));
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    for (std::size_t row = 1; row < num_rows_ && !channels_[i].is_section; ++row) {
      const double here = read_field(row, i);
      if (std::isnan(heading)) heading = here;
      if (!turns(heading, here)) continue;
      support::SourceLocation place;
      field(row, i, place);
      throw support::InputError(
          place, fmt::format("the reference line turns from {} to {} rad; only straight roads are "
                             "read",
                             heading, here));
    }
  }
}

std::vector<double> CrgFile::read_heights(double lateral) const {
  const auto beside = std::lower_bound(sections_.begin(), sections_.end() - 1, lateral);
  const auto left = static_cast<std::size_t>(beside - sections_.begin());
  const double share =
      left == 0 ? 1.0 : (lateral - sections_[left - 1]) / (sections_[left] - sections_[left - 1]);
  std::vector<double> heights;
  for (std::size_t row = 0; row < num_rows_; ++row) {
    double height = share * read_field(row, section_columns_[left]);
    if (share < 1.0) height += (1.0 - share) * read_field(row, section_columns_[left - 1]);
    heights.push_back(height);
  }
  return heights;
}

}  // namespace sprung::dynamics

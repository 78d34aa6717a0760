#include "dynamics/input/road_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "dynamics/measured/column_file.h"
#include "dynamics/measured/crg_file.h"
#include "dynamics/measured/text_check.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::dynamics {

namespace {

constexpr std::string_view kSeparators = " \t\r,";
constexpr double kLevel = 1e-9;  // m, largest height that TableRoad accepts as 0
// m; within these the slopes and curvatures of the spline are finite.
constexpr double kLargest = 1e9, kNearest = 1e-9;

// Reads the next number of a line from position `at`, and moves `at` behind it.
double take_number(std::string_view line, std::size_t& at, const support::SourceLocation& line_start,
                   std::string_view what) {
  const std::size_t begin = line.find_first_not_of(kSeparators, at);
  support::SourceLocation here = line_start;
  if (begin == std::string_view::npos) {
    here.column = static_cast<int>(line.size()) + 1;
    throw support::InputError(here,
                              fmt::format("the {} [m] is missing; a line is a distance and a height", what));
  }
  const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  here.column = static_cast<int>(begin) + 1;
  double value = 0.0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value)) {
    throw support::InputError(here, fmt::format("the {} must be a finite number [m], got '{}'", what, word));
  }
  at = end;
  return value;
}

void read_line(std::string_view line, support::SourceLocation location, RoadPoints& points) {
  line = line.substr(0, line.find('#'));
  const std::size_t first = line.find_first_not_of(kSeparators);
  if (first == std::string_view::npos) return;
  std::size_t at = first;
  const double distance = take_number(line, at, location, "distance");
  const double height = take_number(line, at, location, "height");
  const std::size_t rest = line.find_first_not_of(kSeparators, at);
  location.column = static_cast<int>(rest == std::string_view::npos ? first : rest) + 1;
  if (rest != std::string_view::npos) {
    throw support::InputError(location,
                              "a line has two numbers, a distance and a height [m]; there is more here");
  }
  if (!(std::abs(distance) <= kLargest && std::abs(height) <= kLargest)) {
    throw support::InputError(
        location, fmt::format("distances and heights must be within ±{:g} m, got {} and {}", kLargest,
                              distance, height));
  }
  if (points.distance.empty() && !(std::abs(height) <= kLevel)) {
    throw support::InputError(
        location, fmt::format("the first height must be 0 m, as the road before it, got {}", height));
  }
  if (!points.distance.empty() && !(distance > points.distance.back())) {
    throw support::InputError(location, fmt::format("the distance must ascend, got {} m after {} m", distance,
                                                    points.distance.back()));
  }
  if (!points.distance.empty() && !(distance - points.distance.back() >= kNearest)) {
    throw support::InputError(
        location, fmt::format("the distance must ascend by at least {:g} m, got {} m after {} m", kNearest,
                              distance, points.distance.back()));
  }
  points.distance.push_back(distance);
  points.height.push_back(height);
}

// Two columns of numbers without names.
RoadPoints read_plain_table(const std::filesystem::path& path) {
  const std::string text = support::read_text_file(path);
  check_text(text, path.string());
  RoadPoints points;
  const auto num_lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  points.distance.reserve(num_lines);
  points.height.reserve(num_lines);
  support::SourceLocation location{.path = path.string()};
  const bool has_mark = text.starts_with("\xEF\xBB\xBF");  // byte order mark, as spreadsheets write it
  for (std::size_t begin = has_mark ? 3 : 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    ++location.line;
    read_line(std::string_view(text).substr(begin, end - begin), location, points);
    begin = end + 1;
  }
  if (points.distance.size() < 2) {
    throw support::InputError({.path = path.string()},
                              fmt::format("a road needs at least 2 points, got {}", points.distance.size()));
  }
  return points;
}

// The factor to m of a column of lengths.
double find_length_factor(const Signal& column, const RoadColumn& asked) {
  if (column.unit.empty()) return 1.0;
  const std::optional<KnownUnit> known = find_unit(column.unit);
  if (known && known->si_unit == "m") return known->factor;
  throw support::InputError(asked.location, fmt::format("the column '{}' is in '{}', expected one of {}",
                                                        column.name, column.unit, list_units("m")));
}

std::vector<double> read_lengths(const ColumnFile& file, const RoadColumn& asked) {
  const std::span<const Signal> columns = file.columns();
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const Signal& column) { return column.name == asked.name; });
  if (found == columns.end()) {
    throw support::InputError(asked.location, fmt::format("the file has no column '{}'; it has {}",
                                                          asked.name, list_names(columns)));
  }
  std::vector<double> lengths = file.read_column(static_cast<std::size_t>(found - columns.begin()));
  const double factor = find_length_factor(*found, asked);
  for (double& length : lengths) length *= factor;
  return lengths;
}

// Adds a profile's share of the mean.
void add_share(const std::vector<double>& profile, std::size_t count, std::vector<double>& mean) {
  mean.resize(profile.size(), 0.0);
  for (std::size_t i = 0; i < profile.size(); ++i) mean[i] += profile[i] / static_cast<double>(count);
}

RoadPoints read_named_columns(const RoadDescription& road) {
  const ColumnFile file = ColumnFile::read(road.file);
  RoadColumn distance = road.distance;
  if (distance.name.empty()) distance = {file.columns().front().name, road.file_location};
  for (auto one = road.heights.begin(); one != road.heights.end(); ++one) {
    const auto same = [&](const RoadColumn& other) { return other.name == one->name; };
    if (same(distance))
      throw support::InputError(one->location, fmt::format("'{}' is the column of the distances", one->name));
    if (std::any_of(road.heights.begin(), one, same))
      throw support::InputError(one->location, fmt::format("'height' names '{}' twice", one->name));
  }
  RoadPoints points;
  points.distance = read_lengths(file, distance);
  for (const RoadColumn& column : road.heights)
    add_share(read_lengths(file, column), road.heights.size(), points.height);
  const auto column = std::find_if(file.columns().begin(), file.columns().end(),
                                   [&](const Signal& one) { return one.name == distance.name; });
  for (std::size_t i = 0; i < points.distance.size(); ++i) {
    const bool ascends = i == 0 || points.distance[i] - points.distance[i - 1] >= kNearest;
    if (ascends && std::abs(points.distance[i]) <= kLargest && std::abs(points.height[i]) <= kLargest)
      continue;
    throw support::InputError(
        file.locate(static_cast<std::size_t>(column - file.columns().begin()), i),
        fmt::format(
            "'{}' must ascend by at least {:g} m, and distances and heights be within ±{:g} m; got {} m{}, "
            "height {} m",
            distance.name, kNearest, kLargest, points.distance[i],
            i == 0 ? "" : fmt::format(" after {} m", points.distance[i - 1]), points.height[i]));
  }
  return points;
}

RoadPoints read_crg(const RoadDescription& road) {
  const CrgFile file = CrgFile::read(road.file);
  RoadPoints points;
  for (const double lateral : road.lateral) {
    if (!(lateral >= file.rightmost() && lateral <= file.leftmost())) {
      throw support::InputError(
          road.lateral_location,
          fmt::format("'lateral' must lie on the road, from {} m (right) to {} m (left), got {} m",
                      file.rightmost(), file.leftmost(), lateral));
    }
    add_share(file.read_heights(lateral), road.lateral.size(), points.height);
  }
  for (std::size_t i = 0; i < points.height.size(); ++i) {
    points.distance.push_back(static_cast<double>(i) * file.increment());
  }
  return points;
}

}  // namespace

RoadPoints read_road_points(const RoadDescription& road) {
  if (!support::is_regular_file(road.file)) {
    throw support::InputError(road.file_location,
                              fmt::format("there is no road file {}", road.file.string()));
  }
  if (road.shape == "table" && road.heights.empty()) return read_plain_table(road.file);
  RoadPoints points = road.shape == "opencrg" ? read_crg(road) : read_named_columns(road);
  // The road is level before its first point, whatever height that was measured at.
  const double level = points.height.front();
  for (double& height : points.height) height -= level;
  return points;
}

}  // namespace sprung::dynamics

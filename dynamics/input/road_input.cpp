#include "dynamics/input/road_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/road/table_road.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::dynamics {

namespace {

constexpr std::string_view kSeparators = " \t\r,";
constexpr double kLevel = 1e-9;  // m, largest height that TableRoad accepts as 0
// m; within these the slopes and curvatures of the spline are finite.
constexpr double kLargest = 1e9, kNearest = 1e-9;

struct RoadPoints {
  std::vector<double> distance, height;
};

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

RoadPoints read_road_table(const std::filesystem::path& path) {
  const std::string text = support::read_text_file(path);
  RoadPoints points;
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

}  // namespace

RoadDescription read_road(const support::TomlTable& table, const std::filesystem::path& folder) {
  std::vector<std::string> shapes{"flat"};
  shapes.insert(shapes.end(), bump_shape_names().begin(), bump_shape_names().end());
  shapes.push_back("table");

  RoadDescription road;
  road.location = table.at("shape").location();
  road.shape = table.at("shape").one_of(shapes);
  if (road.shape != "flat") {
    // Where the vehicle starts in equilibrium, the road is level.
    road.start = table.number("start", support::non_negative("m"));
  }
  if (road.shape == "table") {
    road.file = folder / table.string("file");
    road.file_location = table.at("file").location();
  } else if (road.shape != "flat") {
    road.length = table.number("length", support::positive("m"));
    road.height = table.number("height", support::any("m"));
  }
  table.reject_unknown_keys();
  return road;
}

std::unique_ptr<Road> make_road(const RoadDescription& description) {
  if (description.shape == "flat") return std::make_unique<FlatRoad>();
  if (description.shape == "table") {
    if (!std::filesystem::is_regular_file(description.file)) {
      throw support::InputError(description.file_location,
                                fmt::format("there is no road file {}", description.file.string()));
    }
    const RoadPoints points = read_road_table(description.file);
    return std::make_unique<TableRoad>(description.start, points.distance, points.height);
  }
  const std::vector<std::string>& names = bump_shape_names();
  const auto found = std::find(names.begin(), names.end(), description.shape);
  if (found == names.end()) {
    throw std::invalid_argument(fmt::format("make_road: no shape '{}'", description.shape));
  }
  return std::make_unique<BumpRoad>(
      BumpRoad::Parameters{.shape = static_cast<BumpShape>(found - names.begin()),
                           .start = description.start,
                           .length = description.length,
                           .height = description.height});
}

}  // namespace sprung::dynamics

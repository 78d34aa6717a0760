#include "dynamics/input/road_input.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <stdexcept>

#include "dynamics/input/road_points.h"
#include "dynamics/input/spectrum_input.h"
#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/road/table_road.h"

namespace sprung::dynamics {

namespace {

// The names of one column or of several.
std::vector<RoadColumn> read_columns(const support::TomlValue& value) {
  std::vector<RoadColumn> columns;
  if (!value.is_array()) return {{value.string(), value.location()}};
  for (const support::TomlValue& item : value.items()) columns.push_back({item.string(), item.location()});
  if (columns.empty()) throw value.error("must name at least one column");
  return columns;
}

void read_file_keys(const support::TomlTable& table, const std::filesystem::path& folder,
                    RoadDescription& road) {
  road.file = folder / table.string("file");
  road.file_location = table.at("file").location();
  if (road.shape == "opencrg") {
    const support::TomlValue lateral = table.at("lateral");
    road.lateral_location = lateral.location();
    road.lateral = lateral.is_array() ? lateral.numbers(support::any("m"))
                                      : std::vector<double>{lateral.number(support::any("m"))};
    if (road.lateral.empty()) throw lateral.error("must be at least one position [m]");
    return;
  }
  if (const auto height = table.find("height")) road.heights = read_columns(*height);
  if (const auto distance = table.find("distance")) {
    if (road.heights.empty()) throw distance->error("needs a 'height', the column of the heights");
    road.distance = {distance->string(), distance->location()};
  }
}

std::unique_ptr<Road> make_random_road(const RoadDescription& description) {
  try {
    const std::vector<double> height = make_random_heights(*description.random);
    const auto spaced =
        Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(height.size()), 0.0, description.random->length);
    const std::vector<double> distance(spaced.begin(), spaced.end());
    return std::make_unique<TableRoad>(description.start, distance, height);
  } catch (const std::invalid_argument& error) {
    throw support::InputError(description.location, fmt::format("'road' cannot be made: {}", error.what()));
  }
}

}  // namespace

RoadDescription read_road(const support::TomlTable& table, const std::filesystem::path& folder) {
  std::vector<std::string> shapes{"flat"};
  shapes.insert(shapes.end(), bump_shape_names().begin(), bump_shape_names().end());
  shapes.insert(shapes.end(), {"random", "table", "opencrg"});

  RoadDescription road;
  const bool is_class = !table.has("shape") && table.has("class");  // only random roads have one
  road.location = table.at(is_class ? "class" : "shape").location();
  road.shape = is_class ? "random" : table.at("shape").one_of(shapes);
  // Where the vehicle starts in equilibrium, the road is level.
  if (road.shape == "random") {
    road.start = table.number_or("start", 0.0, support::non_negative("m"));
  } else if (road.shape != "flat") {
    road.start = table.number("start", support::non_negative("m"));
  }
  if (road.shape == "table" || road.shape == "opencrg") {
    read_file_keys(table, folder, road);
  } else if (road.shape == "random") {
    road.random = read_random_road(table);
  } else if (road.shape != "flat") {
    road.length = table.number("length", support::positive("m"));
    road.height = table.number("height", support::any("m"));
  }
  table.reject_unknown_keys();
  return road;
}

std::unique_ptr<Road> make_road(const RoadDescription& description) {
  if (description.shape == "flat") return std::make_unique<FlatRoad>();
  if (description.random) return make_random_road(description);
  if (description.shape == "table" || description.shape == "opencrg") {
    const RoadPoints points = read_road_points(description);
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

std::string describe_missed_road(const RoadDescription& description, const Road& road, double speed,
                                 double duration) {
  if (speed < 0.0 && road.num_segments() > 1) {
    return "the vehicle drives against its heading, so that it does not meet the road, which begins ahead of "
           "it";
  }
  if ((description.file.empty() && !description.random) || road.num_segments() < 2) return {};
  const double end = road.segment_end(road.num_segments() - 2);
  if (!(speed * duration > end)) return {};
  return fmt::format(
      "the road ends at {:.6g} m, which the leading axle passes after {:.6g} s of {:.6g} s at the speed of "
      "the start; from there on it is level",
      end, end / speed, duration);
}

std::string describe_unreached_road(const Road& road, double speed, double duration) {
  if (road.num_segments() < 2) return {};
  const double begin = road.segment_end(0);
  if (speed < 0.0 || speed * duration > begin) return {};
  return fmt::format(
      "the road begins {:.6g} m ahead of the leading axle, which does not reach it: at 'speed', {:g} m/s, it "
      "covers {:.6g} m in {:.6g} s",
      begin, speed, speed * duration, duration);
}

std::string remark_on_road(const RoadDescription& description, const Road& road, double speed,
                           double duration) {
  const std::string text = describe_missed_road(description, road, speed, duration);
  if (text.empty()) return {};
  const support::SourceLocation& at =
      description.file.empty() || speed < 0.0 ? description.location : description.file_location;
  return fmt::format("{}: {}", support::format_place(at), text);
}

}  // namespace sprung::dynamics

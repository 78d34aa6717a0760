#include "fem/frame_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace sprung::fem {

namespace {

// Points nearer than this are at one place; relative to the largest distance from the first point.
constexpr double kLeastPointDistance = 1e-9;

void check_points(const FrameGeometry& geometry) {
  std::set<std::string> names;
  double extent = 0.0;
  for (const FrameGeometry::Point& point : geometry.points) {
    if (!names.insert(point.name).second) {
      throw support::InputError(point.where, fmt::format("two points are named '{}'", point.name));
    }
    if (!point.position.allFinite()) {
      throw support::InputError(
          point.where, fmt::format("point '{}' is at ({}, {}), expected finite coordinates in m", point.name,
                                   point.position.x(), point.position.y()));
    }
    const Eigen::Vector2d offset = point.position - geometry.points.front().position;
    extent = std::max(extent, offset.norm());
  }
  for (std::size_t i = 0; i < geometry.points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector2d gap = geometry.points[i].position - geometry.points[j].position;
      if (gap.norm() > kLeastPointDistance * extent) continue;
      throw support::InputError(
          geometry.points[i].where,
          fmt::format("points '{}' and '{}' are at one place, ({:.6g}, {:.6g})", geometry.points[j].name,
                      geometry.points[i].name, geometry.points[i].position.x(),
                      geometry.points[i].position.y()));
    }
  }
}

void check_line(const FrameGeometry::Line& line, const std::vector<std::string>& point_names) {
  for (const std::string& end : {line.from, line.to}) {
    if (std::find(point_names.begin(), point_names.end(), end) != point_names.end()) continue;
    throw support::InputError(line.where, fmt::format("line '{}': there is no point '{}'{}", line.name, end,
                                                      support::nearest_name_hint(end, point_names)));
  }
  if (line.from == line.to) {
    throw support::InputError(line.where,
                              fmt::format("line '{}' begins and ends at '{}'", line.name, line.from));
  }
  if (line.num_elements < 1 || line.num_elements > kMaxElementsPerLine) {
    throw support::InputError(line.where, fmt::format("line '{}' has {} elements, expected 1 … {}", line.name,
                                                      line.num_elements, kMaxElementsPerLine));
  }
}

}  // namespace

void check_frame_geometry(const FrameGeometry& geometry) {
  if (geometry.lines.empty()) throw support::InputError({}, "the frame has no lines");
  check_points(geometry);
  std::vector<std::string> point_names;
  for (const FrameGeometry::Point& point : geometry.points) point_names.push_back(point.name);

  std::set<std::string> line_names;
  std::set<std::string> used;
  std::set<std::pair<std::string, std::string>> ends;
  for (const FrameGeometry::Line& line : geometry.lines) {
    if (!line_names.insert(line.name).second) {
      throw support::InputError(line.where, fmt::format("two lines are named '{}'", line.name));
    }
    check_line(line, point_names);
    if (!ends.insert(std::minmax(line.from, line.to)).second) {
      throw support::InputError(
          line.where, fmt::format("line '{}' joins '{}' and '{}', which another line does already", line.name,
                                  line.from, line.to));
    }
    used.insert({line.from, line.to});
  }
  for (const FrameGeometry::Point& point : geometry.points) {
    if (used.count(point.name) == 0) {
      throw support::InputError(point.where, fmt::format("no line passes through point '{}'", point.name));
    }
  }
}

}  // namespace sprung::fem

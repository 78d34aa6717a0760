#include "fem/frame_geometry.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
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

// Angle from the line's chord to its direction at the end [rad], half of the arc's angle: the directions from
// one end to the place on the arc and on to the other end differ by it.
double calc_half_angle(const FrameGeometry::Line& line, const Eigen::Vector2d& from,
                       const Eigen::Vector2d& to) {
  if (!line.via) return 0.0;
  const Eigen::Vector2d first = *line.via - from, second = to - *line.via;
  return std::atan2(first.x() * second.y() - first.y() * second.x(), first.dot(second));
}

void check_arc(const FrameGeometry::Line& line, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  if (!line.via) return;
  const Eigen::Vector2d& via = *line.via;
  const double least = kLeastPointDistance * (to - from).norm();
  const bool is_at_end = !((via - from).norm() > least && (via - to).norm() > least);
  if (is_at_end || std::abs(calc_half_angle(line, from, to)) > std::numbers::pi - kLeastPointDistance) {
    throw support::InputError(
        line.where,
        fmt::format("line '{}' is an arc via ({:.6g}, {:.6g}), which is {}; expected a place between "
                    "its ends",
                    line.name, via.x(), via.y(),
                    is_at_end ? "at one of its ends" : "in line with its ends, beyond them"));
  }
  if (line.num_elements < 2) {
    throw support::InputError(
        line.where,
        fmt::format("line '{}' is an arc of one element, which is straight; expected at least 2", line.name));
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
  std::map<std::string, Eigen::Vector2d> positions;
  for (const FrameGeometry::Point& point : geometry.points) {
    point_names.push_back(point.name);
    positions[point.name] = point.position;
  }

  std::set<std::string> line_names;
  std::set<std::string> used;
  std::multimap<std::pair<std::string, std::string>, Eigen::Vector2d> middles;
  for (const FrameGeometry::Line& line : geometry.lines) {
    if (!line_names.insert(line.name).second) {
      throw support::InputError(line.where, fmt::format("two lines are named '{}'", line.name));
    }
    check_line(line, point_names);
    const Eigen::Vector2d &from = positions.at(line.from), &to = positions.at(line.to);
    check_arc(line, from, to);
    const Eigen::Vector2d middle = calc_place_on_line(line, from, to, 0.5);
    const auto [first, last] = middles.equal_range(std::minmax(line.from, line.to));
    if (std::any_of(first, last, [&](const auto& other) {
          return (other.second - middle).norm() <= kLeastPointDistance * (to - from).norm();
        })) {
      throw support::InputError(
          line.where, fmt::format("line '{}' joins '{}' and '{}', which another line does already", line.name,
                                  line.from, line.to));
    }
    middles.emplace(std::minmax(line.from, line.to), middle);
    used.insert({line.from, line.to});
  }
  for (const FrameGeometry::Point& point : geometry.points) {
    if (used.count(point.name) == 0) {
      throw support::InputError(point.where, fmt::format("no line passes through point '{}'", point.name));
    }
  }
}

Eigen::Vector2d calc_place_on_line(const FrameGeometry::Line& line, const Eigen::Vector2d& from,
                                   const Eigen::Vector2d& to, double share) {
  const double half = calc_half_angle(line, from, to);
  if (half == 0.0) return (1.0 - share) * from + share * to;
  // The chord to the place: its length is that of sin(share half) beside sin(half).
  const double length = std::sin(share * half) / std::sin(half);
  return from + length * (Eigen::Rotation2Dd((share - 1.0) * half) * (to - from));
}

}  // namespace sprung::fem

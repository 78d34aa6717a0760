#include "dynamics/statistics/run_warning.h"

#include "dynamics/element_input/point_reference.h"

namespace sprung::dynamics {

namespace {

std::vector<std::string> list_points_of(const std::string& body, const RunStatistics& statistics) {
  std::vector<std::string> points;
  for (const PointStatistics& point : statistics.point_statistics()) {
    if (body_of_point(point.point) == body) points.push_back(point.point);
  }
  return points;
}

}  // namespace

std::vector<std::string> list_rows_of(const std::string& body, const RunStatistics& statistics) {
  std::vector<std::string> rows = list_points_of(body, statistics);
  rows.push_back(body);
  return rows;
}

}  // namespace sprung::dynamics

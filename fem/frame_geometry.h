#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/support/errors/input_error.h"

namespace sprung::fem {

inline constexpr int kMaxElementsPerLine = 100000;  ///< of a design, and on a curve of a `.geo` file

/// A frame as a design describes it: named points, and straight lines or arcs of circles between them.
///
/// Lines are joined at common points only: two lines that cross without a point are not connected there.
struct FrameGeometry {
  struct Point {
    std::string name;
    Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m]
    support::SourceLocation where = {};                  ///< for messages
  };
  struct Line {
    std::string name;
    std::string from;      ///< name of the point at its beginning
    std::string to;        ///< name of the point at its end
    std::string section;   ///< section name, copied to the mesh
    int num_elements = 1;  ///< ≥ 1, of equal length; ≥ 2 of an arc
    /// A place on the arc [m]; without it the line is straight.
    std::optional<Eigen::Vector2d> via = {};
    support::SourceLocation where = {};
  };

  std::vector<Point> points;
  std::vector<Line> lines;
  /// Whether something else joins parts of the frame, so that its mesh may fall into several.
  bool may_have_parts = false;
};

/// Checks a frame: there is a line; point and line names are unique; a line's points exist and differ; no two
/// lines join the same points along one way; an arc passes through its place between the ends; num_elements
/// is 1 … kMaxElementsPerLine; positions are finite; no two points have the same position; every point
/// belongs to a line.
/// @throws support::InputError at the location of the point or line
/// Checked by tests/fem/frame_geometry_test.cpp
void check_frame_geometry(const FrameGeometry& geometry);

/// The place at a share of a line's length.
///
/// @param line  of which num_elements and via count, checked
/// @param from, to  its ends [m]   @param share  0 … 1
/// Checked by tests/fem/frame_geometry_test.cpp
Eigen::Vector2d calc_place_on_line(const FrameGeometry::Line& line, const Eigen::Vector2d& from,
                                   const Eigen::Vector2d& to, double share);

}  // namespace sprung::fem

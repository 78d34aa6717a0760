#include "fem/frame_geometry.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

FrameGeometry make_geometry() {
  FrameGeometry geometry;
  geometry.points = {{.name = "left", .position = {0.3, 0.1}, .where = {"a.toml", 3, 1}},
                     {.name = "right", .position = {1.7, 0.4}, .where = {"a.toml", 4, 1}},
                     {.name = "foot", .position = {1.2, -0.8}, .where = {"a.toml", 5, 1}}};
  geometry.lines = {{.name = "rail",
                     .from = "left",
                     .to = "right",
                     .section = "box",
                     .num_elements = 3,
                     .where = {"a.toml", 8, 1}},
                    {.name = "post",
                     .from = "right",
                     .to = "foot",
                     .section = "tube",
                     .num_elements = 2,
                     .where = {"a.toml", 9, 1}}};
  return geometry;
}

template <class Spoil>
std::string message(Spoil&& spoil) {
  FrameGeometry geometry = make_geometry();
  spoil(geometry);
  return test::message_of<support::InputError>([&] { check_frame_geometry(geometry); });
}

}  // namespace

TEST_CASE("A correct line frame is accepted") {
  CHECK_NOTHROW(check_frame_geometry(make_geometry()));
}

TEST_CASE("Each fault of a line frame is refused at its location") {
  CHECK(message([](FrameGeometry& g) { g.lines.clear(); }) == "error: the frame has no lines");
  CHECK(message([](FrameGeometry& g) { g.points[2].name = "left"; }) ==
        "a.toml:5:1: error: two points are named 'left'");
  CHECK(message([](FrameGeometry& g) { g.points[1].position.x() = std::nan(""); }) ==
        "a.toml:4:1: error: point 'right' is at (nan, 0.4), expected finite coordinates in m");
  CHECK(message([](FrameGeometry& g) {
          g.points[2].position = {0.3, 0.1 + 1e-12};
        }) == "a.toml:5:1: error: points 'left' and 'foot' are at one place, (0.3, 0.1)");
  CHECK(message([](FrameGeometry& g) { g.lines[1].name = "rail"; }) ==
        "a.toml:9:1: error: two lines are named 'rail'");
  CHECK(message([](FrameGeometry& g) { g.lines[1].to = "foo"; }) ==
        "a.toml:9:1: error: line 'post': there is no point 'foo' (did you mean 'foot'?)");
  CHECK(message([](FrameGeometry& g) { g.lines[1].to = "right"; }) ==
        "a.toml:9:1: error: line 'post' begins and ends at 'right'");
  CHECK(message([](FrameGeometry& g) { g.lines[0].num_elements = 0; }) ==
        "a.toml:8:1: error: line 'rail' has 0 elements, expected 1 … 100000");
  CHECK(message([](FrameGeometry& g) { g.lines[0].num_elements = 100001; }) ==
        "a.toml:8:1: error: line 'rail' has 100001 elements, expected 1 … 100000");
  CHECK(message([](FrameGeometry& g) {
          g.lines[1].from = "foot", g.lines[1].to = "left", g.lines[0].to = "foot";
        }) == "a.toml:9:1: error: line 'post' joins 'foot' and 'left', which another line does already");
  CHECK(message([](FrameGeometry& g) { g.lines.pop_back(); }) ==
        "a.toml:5:1: error: no line passes through point 'foot'");
}

}  // namespace sprung::fem

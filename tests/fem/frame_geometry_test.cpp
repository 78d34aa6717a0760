#include "fem/frame_geometry.h"

#include <cmath>
#include <numbers>
#include <utility>

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
  CHECK(message([](FrameGeometry& g) {
          g.lines[0].via = {0.3, 0.1};
        }) ==
        "a.toml:8:1: error: line 'rail' is an arc via (0.3, 0.1), which is at one of its ends; expected a "
        "place between its ends");
  CHECK(message([](FrameGeometry& g) {
          g.lines[0].via = {3.1, 0.7};
        }) ==
        "a.toml:8:1: error: line 'rail' is an arc via (3.1, 0.7), which is in line with its ends, beyond "
        "them; expected a place between its ends");
  CHECK(message([](FrameGeometry& g) {
          g.lines[1].via = {1.0, 0.0};
          g.lines[1].num_elements = 1;
        }) ==
        "a.toml:9:1: error: line 'post' is an arc of one element, which is straight; expected at least 2");
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

// Radius 2 about (1, −3): from 10° by 100° to 200°, and the other way round through 300°.
TEST_CASE("Places on an arc lie on its circle at equal angles") {
  const auto place = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return Eigen::Vector2d(1.0 + 2.0 * std::cos(angle), -3.0 + 2.0 * std::sin(angle));
  };
  for (const auto& [via, turn] : {std::pair{100.0, 190.0}, std::pair{300.0, -170.0}}) {
    FrameGeometry::Line arc;
    arc.via = place(via);
    for (const double share : {0.0, 0.1, 0.5, 0.8, 1.0}) {
      const Eigen::Vector2d found = calc_place_on_line(arc, place(10.0), place(200.0), share);
      CHECK((found - place(10.0 + share * turn)).norm() < 1e-14);
    }
  }
}

TEST_CASE("Two points may be joined along different ways") {
  FrameGeometry geometry = make_geometry();
  FrameGeometry::Line arch = geometry.lines[0];
  arch.name = "arch";
  arch.via = {1.0, 0.6};
  geometry.lines.push_back(arch);
  CHECK_NOTHROW(check_frame_geometry(geometry));
  // The same circle by another place on it, at three tenths of it.
  arch.name = "same";
  arch.via = calc_place_on_line(arch, {0.3, 0.1}, {1.7, 0.4}, 0.3);
  geometry.lines.push_back(arch);
  CHECK_THROWS_AS(check_frame_geometry(geometry), support::InputError);
}

}  // namespace sprung::fem

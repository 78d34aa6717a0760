#include "fem/gmsh/gmsh_contents_bytes.h"

#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tools/support/files/bytes.h"

namespace sprung::fem {

namespace {

GmshContents make_contents() {
  GmshContents contents;
  contents.nodes = {{.id = 3, .position = {0.1, -2.5, 1e-300}}, {.id = 7, .position = {1.0 / 3.0, 4.0, 0.0}}};
  contents.points = {{.id = 1, .node = 7, .groups = {4, 5}}, {.id = 2, .node = 3, .groups = {}}};
  contents.lines = {{.id = 9, .first = 3, .second = 7, .curve = 2, .groups = {8}}};
  contents.groups = {{.dimension = 1, .tag = 8, .name = "Längsträger"},
                     {.dimension = 0, .tag = 4, .name = ""}};
  return contents;
}

}  // namespace

TEST_CASE("Contents that are packed and unpacked are the same") {
  const GmshContents before = make_contents();
  const GmshContents after = unpack(pack(before));
  REQUIRE(after.nodes.size() == 2);
  CHECK(after.nodes[1].id == 7);
  CHECK(after.nodes[0].position == before.nodes[0].position);
  CHECK(after.nodes[1].position == before.nodes[1].position);
  REQUIRE(after.points.size() == 2);
  CHECK(after.points[0].groups == std::vector<int>{4, 5});
  CHECK(after.points[1].node == 3);
  REQUIRE(after.lines.size() == 1);
  CHECK(after.lines[0].first == 3);
  CHECK(after.lines[0].curve == 2);
  CHECK(after.lines[0].groups == std::vector<int>{8});
  REQUIRE(after.groups.size() == 2);
  CHECK(after.groups[0].name == "Längsträger");
  CHECK(pack(after) == pack(before));
}

TEST_CASE("Bytes that are cut off or too many are refused") {
  const std::string bytes = pack(make_contents());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CHECK_THROWS_AS(unpack(bytes.substr(0, size)), support::DamagedBytes);
  }
  CHECK_THROWS_AS(unpack(bytes + "x"), support::DamagedBytes);
}

}  // namespace sprung::fem

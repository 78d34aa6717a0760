#include "fem/gmsh/gmsh_contents.h"

#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

// An L of three lines in two physical curves, given in no particular order, in the plane z = 0.7.
GmshContents make_contents() {
  GmshContents contents;
  contents.nodes = {{.id = 9, .position = {1.2, -0.8, 0.7}},
                    {.id = 2, .position = {0.3, 0.1, 0.7}},
                    {.id = 4, .position = {1.7, 0.4, 0.7}},
                    {.id = 7, .position = {1.0, 0.25, 0.7}},
                    {.id = 5, .position = {0.4, 3.1, 5.2}}};  // a construction point, anywhere
  contents.points = {{.id = 1, .node = 9, .groups = {6}},
                     {.id = 2, .node = 2, .groups = {5}},
                     {.id = 3, .node = 5, .groups = {}}};
  contents.lines = {{.id = 30, .first = 9, .second = 4, .curve = 2, .groups = {3}},
                    {.id = 10, .first = 2, .second = 7, .curve = 1, .groups = {8}},
                    {.id = 20, .first = 7, .second = 4, .curve = 1, .groups = {8}}};
  contents.groups = {{.dimension = 1, .tag = 8, .name = "rail"},
                     {.dimension = 0, .tag = 6, .name = "foot"},
                     {.dimension = 1, .tag = 3, .name = "post"},
                     {.dimension = 0, .tag = 5, .name = "left"}};
  return contents;
}

template <class Spoil>
std::string message(Spoil&& spoil) {
  GmshContents contents = make_contents();
  spoil(contents);
  return test::message_of<support::InputError>([&] { make_mesh(contents, {.path = "l.msh"}); });
}

}  // namespace

TEST_CASE("Nodes, elements, sections and names are in the order of the file's numbers") {
  const Mesh mesh = make_mesh(make_contents(), {});
  CHECK(mesh.node_ids == std::vector<std::int64_t>{2, 4, 7, 9});
  Eigen::Matrix2Xd positions(2, 4);
  positions << 0.3, 1.7, 1.0, 1.2, 0.1, 0.4, 0.25, -0.8;
  CHECK(mesh.node_positions == positions);
  CHECK(mesh.section_names == std::vector<std::string>{"post", "rail"});
  REQUIRE(mesh.num_elements() == 3);
  const int expected[3][3] = {{0, 2, 1}, {2, 1, 1}, {3, 1, 0}};
  for (std::size_t e = 0; e < 3; ++e) {
    CHECK(mesh.elements[e].first == expected[e][0]);
    CHECK(mesh.elements[e].second == expected[e][1]);
    CHECK(mesh.elements[e].section == expected[e][2]);
  }
  CHECK(find_node(mesh, "left") == 0);
  CHECK(find_node(mesh, "foot") == 3);
}

TEST_CASE("Two groups of one name are one section, and names without a point are ignored") {
  GmshContents contents = make_contents();
  contents.groups[0].name = "post";
  contents.groups.push_back({.dimension = 0, .tag = 77, .name = "nowhere"});
  contents.groups.push_back({.dimension = 0, .tag = 78, .name = ""});
  const Mesh mesh = make_mesh(contents, {});
  CHECK(mesh.section_names == std::vector<std::string>{"post"});
  CHECK(mesh.named_nodes.size() == 2);
}

TEST_CASE("Contents that are no frame are refused with the reason") {
  CHECK(message([](GmshContents& c) { c.lines.clear(); }) == "l.msh: error: the mesh has no line elements");
  CHECK(message([](GmshContents& c) { c.lines[2].groups.clear(); }) ==
        "l.msh: error: line element 20 of curve 1, from node 7 to node 4, is in no physical curve, which "
        "would name its section");
  CHECK(message([](GmshContents& c) {
          c.lines[2].groups = {8, 3};
        }) ==
        "l.msh: error: line element 20 of curve 1, from node 7 to node 4, is in two physical curves, 3 "
        "'post' and 8 'rail'");
  // format 2.2 lists such an element twice
  CHECK(message([](GmshContents& c) {
          c.lines.push_back({.id = 40, .first = 4, .second = 7, .curve = 1, .groups = {3}});
        }) ==
        "l.msh: error: line element 40 of curve 1, from node 4 to node 7, is in two physical curves, 3 "
        "'post' and 8 'rail'");
  CHECK(message([](GmshContents& c) {
          c.lines.push_back({.id = 40, .first = 4, .second = 7, .curve = 1, .groups = {8}});
        }) == "l.msh: error: two elements join node 4 at (1.7, 0.4) and node 7 at (1, 0.25)");
  CHECK(message([](GmshContents& c) { c.groups[2].name = ""; }) ==
        "l.msh: error: physical curve 3 has no name, which would name its section");
  CHECK(message([](GmshContents& c) { c.nodes[3].position.z() = 0.71; }) ==
        "l.msh: error: node 2 is at z = 0.7 and node 7 at z = 0.71, expected a plane frame, z the same "
        "everywhere");
  CHECK(message([](GmshContents& c) { c.points[2].groups = {6}; }) ==
        "l.msh: error: physical point 'foot' has several points, expected one");
  CHECK(message([](GmshContents& c) { c.groups[3].name = "foot"; }) ==
        "l.msh: error: physical point 'foot' has several points, expected one");
  CHECK(message([](GmshContents& c) { c.points[0].node = 5; }) ==
        "l.msh: error: no line passes through physical point 'foot'");
  CHECK(message([](GmshContents& c) { c.points.pop_back(); }) ==
        "l.msh: error: node 5 belongs to no line element");
  test::check_contains(message([](GmshContents& c) { c.lines.pop_back(); }),
                       "l.msh: error: the frame falls into 2 parts");
}

}  // namespace sprung::fem

#include "fem/mesh.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

// The message of check_mesh for the general frame with a fault.
template <class Spoil>
std::string message(Spoil&& spoil) {
  Mesh mesh = test::make_general_frame().mesh;
  spoil(mesh);
  return test::message_of<support::InputError>([&] { check_mesh(mesh, {.path = "arm.toml", .line = 7}); });
}

void add_node(Mesh& mesh, double x, double y) {
  mesh.node_ids.push_back(mesh.node_ids.back() + 5);
  mesh.node_positions.conservativeResize(2, mesh.num_nodes());
  mesh.node_positions.col(mesh.num_nodes() - 1) << x, y;
}

}  // namespace

TEST_CASE("A correct frame is accepted, and beams may cross without a joint") {
  Mesh mesh = test::make_general_frame().mesh;
  CHECK_NOTHROW(check_mesh(mesh, {}));
  mesh.elements.push_back({0, 3, 1});  // crosses the beam from node 1 to node 2
  CHECK_NOTHROW(check_mesh(mesh, {}));
}

TEST_CASE("Nodes are found by name, and described by number, name and position") {
  const Mesh mesh = test::make_general_frame().mesh;
  CHECK(find_node(mesh, "tip") == 4);
  CHECK(find_node(mesh, "heel") == -1);
  CHECK(describe_node(mesh, 4) == "node 20 'tip' at (3.35, 0.28)");
  CHECK(describe_node(mesh, 0) == "node 3 at (0.31, -0.42)");
  CHECK(calc_length(mesh, mesh.elements[0]) == Approx(std::hypot(1.42, 0.53)).epsilon(1e-15));
}

TEST_CASE("A frame in two parts is refused, naming the nodes of the smaller") {
  const std::string text = message([](Mesh& mesh) { mesh.elements.erase(mesh.elements.begin() + 3); });
  test::check_contains(
      text,
      "arm.toml:7: error: the frame falls into 2 parts that no element joins; one of them has "
      "node 11 at (2.61, 1.02), node 20 'tip' at (3.35, 0.28)");
}

TEST_CASE("A frame beyond all sizes is refused") {
  CHECK(message([](Mesh& mesh) { mesh.node_positions *= 1e300; }).find("m large, expected 1e-12 … 1e+12 m") !=
        std::string::npos);
  CHECK(message([](Mesh& mesh) {
          mesh.node_positions *= 1e-300;
        }).find("m large, expected 1e-12 … 1e+12 m") != std::string::npos);
}

TEST_CASE("A long separate part is abridged") {
  const std::string text = message([](Mesh& mesh) {
    for (int i = 0; i < 12; ++i) {  // twelve nodes of a beam far off; the frame's five are the smaller part
      add_node(mesh, 10.0 + i, 3.0 + 0.1 * i);
      if (i > 0) mesh.elements.push_back({4 + i, 5 + i, 0});
    }
    for (int i = 0; i < 5; ++i) {  // now the frame has ten
      add_node(mesh, -1.0 - i, 0.3 * i);
      mesh.elements.push_back({i == 0 ? 0 : 16 + i, 17 + i, 0});
    }
  });
  test::check_contains(text, "node 3 at (0.31, -0.42)");
  test::check_contains(text, " and 2 more");
}

TEST_CASE("A node without an element is refused") {
  test::check_contains(message([](Mesh& mesh) { add_node(mesh, 5.1, 2.2); }),
                       "no element at node 25 at (5.1, 2.2)");
}

TEST_CASE("An element without length is refused") {
  test::check_contains(message([](Mesh& mesh) {
                         mesh.elements.push_back({2, 2, 0});
                       }),
                       "element between node 8 at (0.94, 1.37) and node 8 at (0.94, 1.37) has no length");
  test::check_contains(message([](Mesh& mesh) {
                         add_node(mesh, 0.94 + 1e-11, 1.37);
                         mesh.elements.push_back({2, 5, 0});
                       }),
                       "has no length");
}

TEST_CASE("Two elements between the same nodes are refused, whatever their direction") {
  test::check_contains(message([](Mesh& mesh) {
                         mesh.elements.push_back({3, 1, 1});
                       }),
                       "two elements join node 4 'corner' at (1.73, 0.11) and node 11 at (2.61, 1.02)");
}

TEST_CASE("Two nodes at the same position are refused, near ones are not") {
  const auto add_branch = [](double x, double y) {
    return message([=](Mesh& mesh) {
      add_node(mesh, x, y);
      mesh.elements.push_back({2, 5, 0});
    });
  };
  test::check_contains(add_branch(2.61 - 2e-10, 1.02 + 2e-10),
                       "node 11 at (2.61, 1.02) and node 25 at (2.61, 1.02) are at one place but not joined");
  CHECK(add_branch(2.61 - 1e-6, 1.02) == "nothing was thrown");
}

TEST_CASE("Positions that are not finite, and a mesh without elements, are refused") {
  test::check_contains(message([](Mesh& mesh) { mesh.node_positions(1, 3) = std::nan(""); }),
                       "node 11 at (2.61, nan) has no finite position");
  test::check_contains(message([](Mesh& mesh) { mesh.elements.clear(); }), "the mesh has no line elements");
}

}  // namespace sprung::fem

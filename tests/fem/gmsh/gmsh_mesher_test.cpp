#include "fem/gmsh/gmsh_mesher.h"

#include <fcntl.h>
#include <unistd.h>

#include <clocale>
#include <cmath>
#include <csignal>
#include <cstdio>

#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

constexpr double kGmshPlacing = 1e-11;  // [m], how exactly gmsh 4.8 places nodes on curves of about 1 m

FrameGeometry make_geometry() {
  FrameGeometry geometry;
  geometry.points = {{.name = "left", .position = {0.3, 0.1}},
                     {.name = "right", .position = {1.7, 0.4}},
                     {.name = "foot", .position = {1.2, -0.8}}};
  geometry.lines = {{.name = "upper", .from = "right", .to = "left", .section = "rail", .num_elements = 7},
                    {.name = "post", .from = "foot", .to = "right", .section = "post", .num_elements = 1},
                    {.name = "lower", .from = "left", .to = "foot", .section = "rail", .num_elements = 3}};
  return geometry;
}

bool equal(const Mesh& a, const Mesh& b) {
  const auto same_element = [](const Mesh::Element& x, const Mesh::Element& y) {
    return x.first == y.first && x.second == y.second && x.section == y.section;
  };
  const auto same_name = [](const Mesh::NamedNode& x, const Mesh::NamedNode& y) {
    return x.name == y.name && x.node == y.node;
  };
  return a.node_ids == b.node_ids && a.node_positions == b.node_positions &&
         a.section_names == b.section_names &&
         std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(), b.elements.end(),
                    same_element) &&
         std::equal(a.named_nodes.begin(), a.named_nodes.end(), b.named_nodes.begin(), b.named_nodes.end(),
                    same_name);
}

std::string message(const std::filesystem::path& path) {
  return test::message_of<support::InputError>([&] { read_gmsh_file(path); });
}
std::string message_of_text(const std::string& name, const std::string& text) {
  return message(test::write_file(name, text));
}

// What a call prints on standard output and error.
template <class Call>
std::string capture_output(Call&& call) {
  const int file = ::open("output.txt", O_CREAT | O_TRUNC | O_RDWR, 0600);
  std::fflush(nullptr);
  const int out = ::dup(1), err = ::dup(2);
  ::dup2(file, 1);
  ::dup2(file, 2);
  call();
  std::fflush(nullptr);
  ::dup2(out, 1);
  ::dup2(err, 2);
  for (const int descriptor : {file, out, err}) ::close(descriptor);
  return test::read_file("output.txt");
}

}  // namespace

TEST_CASE("Lines are divided into equal elements from their beginning to their end") {
  const FrameGeometry geometry = make_geometry();
  const Mesh mesh = mesh_lines(geometry);
  REQUIRE(mesh.num_nodes() == 3 + 6 + 0 + 2);
  REQUIRE(mesh.num_elements() == 11);
  for (int node = 0; node < mesh.num_nodes(); ++node)
    CHECK(mesh.node_ids[static_cast<std::size_t>(node)] == node + 1);
  CHECK(mesh.section_names == std::vector<std::string>{"rail", "post"});
  CHECK(find_node(mesh, "left") == 0);
  CHECK(find_node(mesh, "right") == 1);
  CHECK(find_node(mesh, "foot") == 2);

  std::size_t e = 0;
  int inner = 3;
  for (const FrameGeometry::Line& line : geometry.lines) {
    const Eigen::Vector2d from = mesh.node_positions.col(find_node(mesh, line.from));
    const Eigen::Vector2d to = mesh.node_positions.col(find_node(mesh, line.to));
    int first = find_node(mesh, line.from);
    for (int k = 1; k <= line.num_elements; ++k, ++e) {
      const int second = k == line.num_elements ? find_node(mesh, line.to) : inner++;
      CHECK(mesh.elements[e].first == first);
      CHECK(mesh.elements[e].second == second);
      CHECK(mesh.section_names[static_cast<std::size_t>(mesh.elements[e].section)] == line.section);
      const Eigen::Vector2d error =
          mesh.node_positions.col(second) - (from + static_cast<double>(k) / line.num_elements * (to - from));
      CHECK(error.norm() < 1e-15);
      first = second;
    }
  }
  CHECK(mesh.node_positions.col(1) == Eigen::Vector2d(1.7, 0.4));
}

TEST_CASE("A line of many elements has them equal") {
  FrameGeometry geometry = make_geometry();
  geometry.lines[0].num_elements = 2000;
  const Mesh mesh = mesh_lines(geometry);
  const double expected = std::hypot(1.4, 0.3) / 2000.0;
  double largest = 0.0;
  for (std::size_t e = 0; e < 2000; ++e) {
    largest = std::max(largest, std::abs(calc_length(mesh, mesh.elements[e]) / expected - 1.0));
  }
  CHECK(largest < 1e-12);  // rounding of coordinates of 1 m to 2e-16 m, in elements of 7e-4 m
}

TEST_CASE("Lines that cross without a common point stay apart") {
  FrameGeometry geometry;
  geometry.points = {{.name = "a", .position = {0.1, 0.2}},
                     {.name = "b", .position = {2.1, 1.2}},
                     {.name = "c", .position = {2.3, 0.1}},
                     {.name = "d", .position = {0.2, 1.4}}};
  geometry.lines = {{.name = "ab", .from = "a", .to = "b", .section = "s", .num_elements = 1},
                    {.name = "bc", .from = "b", .to = "c", .section = "s", .num_elements = 1},
                    {.name = "cd", .from = "c", .to = "d", .section = "s", .num_elements = 1}};
  const Mesh mesh = mesh_lines(geometry);
  CHECK(mesh.num_nodes() == 4);
  CHECK(mesh.num_elements() == 3);

  geometry.lines.erase(geometry.lines.begin() + 1);  // now nothing joins the two
  geometry.lines[0].where = {.path = "x.toml", .line = 5};
  test::check_contains(
      test::message_of<support::InputError>([&] { mesh_lines(geometry); }),
      "x.toml:5: error: the frame falls into 2 parts that no element joins; one of them has node 3 'c' "
      "at (2.3, 0.1), node 4 'd' at (0.2, 1.4)");
}

TEST_CASE("A faulty line frame is refused before it is meshed") {
  FrameGeometry geometry = make_geometry();
  geometry.lines[2].to = "fot";
  test::check_contains(test::message_of<support::InputError>([&] { mesh_lines(geometry); }),
                       "line 'lower': there is no point 'fot' (did you mean 'foot'?)");
}

TEST_CASE("A .geo file is meshed along its curves, in its plane, without its construction points") {
  const Mesh mesh = read_gmsh_file(test::get_data("portal.geo"));
  CHECK(mesh.node_ids == std::vector<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(mesh.section_names == std::vector<std::string>{"rail", "post"});
  CHECK(find_node(mesh, "left") == 0);
  CHECK(find_node(mesh, "foot") == 2);
  // rail from point 1 to 2, post along the arc from 2 to 3, then the brace, which its group takes backwards
  const int expected[9][3] = {{0, 3, 0}, {3, 4, 0}, {4, 1, 0}, {1, 5, 1}, {5, 6, 1},
                              {6, 7, 1}, {7, 2, 1}, {8, 0, 1}, {2, 8, 1}};
  REQUIRE(mesh.num_elements() == 9);
  for (std::size_t e = 0; e < 9; ++e) {
    INFO("element " << e);
    CHECK(mesh.elements[e].first == expected[e][0]);
    CHECK(mesh.elements[e].second == expected[e][1]);
    CHECK(mesh.elements[e].section == expected[e][2]);
  }
  const Eigen::Vector2d third = mesh.node_positions.col(4) - Eigen::Vector2d(0.3 + 2.0 / 3.0 * 1.4, 0.3);
  CHECK(third.norm() < kGmshPlacing);
  for (const int node : {1, 5, 6, 7, 2}) {  // radius² 0.845 about (0.85, 0.05)
    const Eigen::Vector2d radius = mesh.node_positions.col(node) - Eigen::Vector2d(0.85, 0.05);
    CHECK(radius.norm() == Approx(std::sqrt(0.845)).margin(kGmshPlacing));
  }
}

TEST_CASE("Both mesh formats, text and binary, give the mesh of the .geo file") {
  const Mesh expected = read_gmsh_file(test::get_data("portal.geo"));
  for (const char* name :
       {"portal_22.msh", "portal_22_binary.msh", "portal_41.msh", "portal_41_binary.msh"}) {
    INFO(name);
    Mesh mesh = read_gmsh_file(test::get_data(name));
    CHECK((mesh.node_positions - expected.node_positions).lpNorm<Eigen::Infinity>() <
          1e-15);  // 16 digits in text
    mesh.node_positions = expected.node_positions;
    CHECK(equal(mesh, expected));
  }
}

TEST_CASE("A .geo file is scaled by its Mesh.ScalingFactor, as gmsh scales the mesh that it saves") {
  const std::string script =
      "Point(1) = {100, 200, 50}; Point(2) = {1500, 900, 50}; Line(1) = {1, 2};"
      "Transfinite Curve {1} = 3; Physical Curve(\"bar\") = {1};\n"
      "Mesh.ScalingFactor = 0.001;\n";
  const Mesh mesh = read_gmsh_file(test::write_file("millimetres.geo", script));
  Eigen::Matrix<double, 2, 3> expected;  // [m], the middle last; gmsh 4.8 saves the same numbers
  expected << 0.1, 1.5, 0.8, 0.2, 0.9, 0.55;
  CHECK((mesh.node_positions - expected).lpNorm<Eigen::Infinity>() < kGmshPlacing);
}

TEST_CASE("Reading is repeatable, independent of earlier files") {
  const Mesh before = read_gmsh_file(test::get_data("portal.geo"));
  const std::string script =
      "Point(1) = {0.1, 0.2, 0}; Point(2) = {L, 0.9, 0}; Line(1) = {1, 2}; Transfinite Curve {1} = 2;"
      "Physical Curve(\"bar\") = {1};\n";
  const auto read_end = [](const std::filesystem::path& path) {
    return read_gmsh_file(path).node_positions(0, 1);
  };
  // gmsh keeps a constant of this kind for the whole process unless told otherwise
  CHECK(read_end(test::write_file("one.geo", "DefineConstant[ L = {1.5, Name \"length\"} ];\n" + script)) ==
        1.5);
  CHECK(read_end(test::write_file("two.geo", "DefineConstant[ L = {2.5, Name \"length\"} ];\n" + script)) ==
        2.5);
  CHECK(message_of_text("bad.geo", "Point(1) = {0, 0, 0;\n") != "nothing was thrown");
  CHECK(equal(read_gmsh_file(test::get_data("portal.geo")), before));
  CHECK(equal(mesh_lines(make_geometry()), mesh_lines(make_geometry())));
}

TEST_CASE("gmsh prints nothing and leaves signal handlers as they were") {
  struct sigaction before[32], after = {};
  for (int signal = 1; signal < 32; ++signal) ::sigaction(signal, nullptr, &before[signal]);
  CHECK(capture_output([] {
          mesh_lines(make_geometry());
          read_gmsh_file(test::get_data("portal_41.msh"));
          message_of_text("bad.geo", "Point(1) = {0, 0, 0;\n");
        }).empty());
  for (int signal = 1; signal < 32; ++signal) {
    ::sigaction(signal, nullptr, &after);
    CHECK(after.sa_handler == before[signal].sa_handler);
  }
}

TEST_CASE("gmsh leaves the locale as it was") {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name :
       {"C", "C.UTF-8"}) {  // gmsh sets the user's, with C for numbers: one of the two would change
    REQUIRE(std::setlocale(LC_ALL, name) != nullptr);
    const std::string locale = std::setlocale(LC_ALL, nullptr);
    mesh_lines(make_geometry());
    CHECK(std::setlocale(LC_ALL, nullptr) == locale);
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("Files that cannot be meshed are refused with path and reason") {
  test::check_contains(message("no_such_file.msh"), "no_such_file.msh: error: ");
  test::check_contains(message("no_such_file.geo"), "no_such_file.geo: error: ");
  CHECK(message_of_text("empty.msh", "") == "empty.msh: error: the file is empty");
  CHECK(message_of_text("empty.geo", "") == "empty.geo: error: the file is empty");
  CHECK(message_of_text("mesh.stl", "solid") == "mesh.stl: error: the file's name must end in .geo or .msh");
  CHECK(message_of_text("points.geo", "Point(1) = {0, 0, 0};\n") ==
        "points.geo: error: the mesh has no line elements");
  test::check_contains(message_of_text("syntax.geo", "Point(1) = {0, 0, 0};\nLine(1) = {1, 2;\n"),
                       "syntax.geo: error: gmsh: 'syntax.geo', line 2: syntax error");
  test::check_contains(message_of_text("unknown.geo", "Point(1) = {0, 0, 0};\nLine(1) = {1, 7};\n"),
                       "unknown.geo: error: gmsh: ");
}

TEST_CASE("A mesh that is truncated anywhere is refused") {
  for (const char* name :
       {"portal_22.msh", "portal_22_binary.msh", "portal_41.msh", "portal_41_binary.msh"}) {
    const std::string whole = test::read_file(test::get_data(name));
    const std::size_t last = whole.find("$EndElements") + std::string("$EndElements").size();
    for (std::size_t size = 0; size < last; ++size) {
      const std::string text = message_of_text("truncated.msh", whole.substr(0, size));
      INFO(name << " cut to " << size << " bytes: " << text);
      CHECK(text.rfind("truncated.msh: error: ", 0) == 0);
    }
  }
}

TEST_CASE("A mesh that declares more than gmsh reads is refused") {
  const std::string text = test::read_file(test::get_data("portal_22.msh"));
  const auto short_message = [&](std::string_view from, std::string_view to) {
    return message_of_text("short.msh", test::replace(text, from, to));
  };
  CHECK(short_message("$Elements\n11\n", "$Elements\n12\n") ==
        "short.msh: error: $Elements: declares 12 elements, but has lines for 11");
  CHECK(short_message("6 1 2 2 2 2 6\n", "") ==
        "short.msh: error: $Elements: declares 11 elements, but has lines for 10");
  CHECK(short_message("\n4 0.76666", "\n5 0.76666") == "short.msh: error: gmsh: Wrong node index 4");
  // gmsh ignores these two without a message
  CHECK(message_of_text("short.msh", test::replace(test::replace(text, "$Nodes\n9\n", "$Nodes\n10\n"),
                                                   "$EndNodes", "12 5.1 2.2 0.7\n$EndNodes")) ==
        "short.msh: error: the file declares 10 nodes, but 9 could be read: it is truncated, or some "
        "belong to no element or have the same number");
  CHECK(short_message("\n4 1 2 1 1 4 5", "\n3 1 2 1 1 4 5") ==
        "short.msh: error: the file declares 11 elements, but 10 could be read: it is truncated, or some "
        "belong to no element or have the same number");
}

TEST_CASE("Reading a .geo file writes no file and runs no program") {
  const std::string script = test::read_file(test::get_data("portal.geo"));
  for (const char* statement :
       {"Save \"written.msh\";", "Print \"written.msh\";", "SystemCall \"touch written.msh\";",
        "Printf(\"%g\", 1) > \"written.msh\";"}) {
    INFO(statement);
    std::filesystem::remove("written.msh");
    test::check_contains(
        message_of_text("saving.geo", "Mesh 1;\n  " + std::string(statement) + "\n" + script),
        "' writes a file or runs a program, which reading a mesh does not");
    CHECK(!std::filesystem::exists("written.msh"));
  }
  test::check_contains(message_of_text("saving.geo", "a = 1;\n  Save \"written.msh\";\n" + script),
                       "saving.geo:2:3: error: 'Save' writes a file");
}

TEST_CASE("Options of gmsh that lie beside a mesh file have no part in it") {
  const std::string options =
      "Mesh.ScalingFactor = 2; Mesh.ElementOrder = 2; SystemCall \"touch written.msh\";";
  std::filesystem::remove("written.msh");
  for (const char* name : {"portal.geo", "portal_22.msh", "portal_41.msh"}) {
    INFO(name);
    const std::filesystem::path path = test::write_file(name, test::read_file(test::get_data(name)));
    const std::filesystem::path beside = test::write_file(std::string(name) + ".opt", options);
    if (path.extension() == ".geo") {
      CHECK(message(path).find("error: gmsh would read the options in '" + beside.string() + "'") !=
            std::string::npos);
    } else {
      CHECK(equal(read_gmsh_file(path), read_gmsh_file(test::get_data(name))));
    }
    std::filesystem::remove(beside);
    std::filesystem::remove(path);
  }
  CHECK(!std::filesystem::exists("written.msh"));
}

TEST_CASE("A curve of a .geo file has as many elements as a line of a design at most") {
  const auto read_bar = [](const std::string& size, const std::string& more) {
    const std::string points = "Point(1) = {0, 0, 0, " + size + "}; Point(2) = {1, 0, 0, " + size + "};";
    return test::write_file("fine.geo", points + "Line(7) = {1, 2}; Physical Curve(\"bar\") = {7};\n" + more);
  };
  const char* const refusal =
      "fine.geo: error: curve 7 has about 1.0e+07 elements by its mesh size, expected";
  test::check_contains(message(read_bar("1e-7", "")), refusal);
  test::check_contains(message(read_bar("1", "Mesh.CharacteristicLengthMax = 1e-7;")), refusal);
  test::check_contains(message(read_bar("1", "Transfinite Curve {7} = 10000001;")),
                       "curve 7 has about 9.0e+06 elements");  // of 10 of its points
  test::check_contains(message(read_bar("1e-10", "")), "curve 7 has about 1.0e+10 elements");
  test::check_contains(message(read_bar("9.9e-6", "")), "curve 7 has about 1.0e+05 elements");
  CHECK(read_gmsh_file(read_bar("2e-5", "")).num_elements() == 50000);
}

TEST_CASE("A least number of elements along circles is no fine mesh size") {
  const std::string arc =
      "Point(1) = {1, 0, 0, 1}; Point(2) = {0, 1, 0, 1}; Point(3) = {0, 0, 0, 1}; Circle(1) = {1, 3, 2};"
      "Physical Curve(\"arc\") = {1}; Mesh.MinimumCirclePoints = ";
  CHECK(read_gmsh_file(test::write_file("arc.geo", arc + "2000;\n")).num_elements() == 500);  // of a quarter
  CHECK(message_of_text("arc.geo", arc + "500000;\n") ==
        "arc.geo: error: curve 1 has more than 100000 elements");
}

TEST_CASE("Physical groups decide the section of each element") {
  const std::string text = test::read_file(test::get_data("portal_22.msh"));
  // elements of one curve in two groups, as other programs write them: each has its own
  const Mesh mesh =
      read_gmsh_file(test::write_file("mixed.msh", test::replace(text, "4 1 2 1 1 4 5", "4 1 2 2 1 4 5")));
  CHECK(mesh.section_names[static_cast<std::size_t>(mesh.elements[0].section)] == "rail");
  CHECK(mesh.section_names[static_cast<std::size_t>(mesh.elements[1].section)] == "post");
  CHECK(mesh.section_names[static_cast<std::size_t>(mesh.elements[2].section)] == "rail");

  CHECK(message_of_text("none.msh", test::replace(text, "4 1 2 1 1 4 5", "4 1 2 0 1 4 5")) ==
        "none.msh: error: line element 4 of curve 1, from node 4 to node 5, is in no physical curve, which "
        "would name its section");
  CHECK(message_of_text("unnamed.msh", test::replace(text, "4 1 2 1 1 4 5", "4 1 2 9 1 4 5")) ==
        "unnamed.msh: error: physical curve 9 has no name, which would name its section");

  const std::string script = test::read_file(test::get_data("portal.geo"));
  test::check_contains(
      message_of_text("none.geo", test::replace(script, "{2, -3}", "{2}")),
      "of curve 3, from node 1 to node 10, is in no physical curve, which would name its section");
  test::check_contains(
      message_of_text("two.geo", test::replace(script, "{2, -3}", "{2, 3, 1}")),
      "two.geo: error: line element 3 of curve 1, from node 1 to node 4, is in two physical curves, 1 "
      "'rail' and 2 'post'");
  CHECK(message_of_text("unnamed.geo", test::replace(script, "\"rail\"", "17")) ==
        "unnamed.geo: error: physical curve 17 has no name, which would name its section");
  test::check_contains(
      message_of_text("several.geo", test::replace(script, "(\"foot\") = {3}", "(\"foot\") = {3, 2}")),
      "several.geo: error: physical point 'foot' has several points, expected one");
  test::check_contains(
      message_of_text("centre.geo", test::replace(script, "(\"foot\") = {3}", "(\"foot\") = {4}")),
      "centre.geo: error: no line passes through physical point 'foot'");
}

TEST_CASE("A mesh that is no plane frame of two-node lines is refused") {
  const std::string script = test::read_file(test::get_data("portal.geo"));
  CHECK(message_of_text("quadratic.geo", script + "Mesh.ElementOrder = 2;\n") ==
        "quadratic.geo: error: element 3 is a Line 3, expected straight two-node lines only");
  const std::string text = test::read_file(test::get_data("portal_22.msh"));
  const std::string triangle = test::replace(text, "$EndElements", "12 2 2 2 1 1 4 9\n$EndElements");
  CHECK(message_of_text("triangle.msh", test::replace(triangle, "$Elements\n11", "$Elements\n12")) ==
        "triangle.msh: error: element 12 is a Triangle 3, expected straight two-node lines only");
  test::check_contains(
      message_of_text("tilted.geo", test::replace(script, "{1.2, -0.8, 0.7}", "{1.2, -0.8, 0.9}")),
      "expected a plane frame, z the same everywhere");
  test::check_contains(
      message_of_text("apart.geo", script +
                                       "Point(7) = {3, 1, 0.7}; Point(8) = {4, 2, 0.7}; Line(7) = {7, 8};"
                                       "Transfinite Curve {7} = 2; Physical Curve(\"far\") = {7};\n"),
      "apart.geo: error: the frame falls into 2 parts that no element joins; one of them has node");
}

}  // namespace sprung::fem

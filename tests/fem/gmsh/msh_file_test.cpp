#include "fem/gmsh/msh_file.h"

#include <fmt/format.h>

#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tools/support/errors/input_error.h"

namespace sprung::fem {

namespace {

std::string message(std::string_view text) {
  const std::filesystem::path path = test::write_file("declaration.msh", text);
  return test::message_of<support::InputError>([&] { read_msh_declaration(path); });
}

}  // namespace

TEST_CASE("The declaration is read from both formats, text and binary") {
  for (const char* name :
       {"portal_22.msh", "portal_22_binary.msh", "portal_41.msh", "portal_41_binary.msh"}) {
    INFO(name);
    const MshDeclaration declaration = read_msh_declaration(test::get_data(name));
    CHECK(declaration.num_nodes == 9);
    CHECK(declaration.num_elements == 11);
    if (declaration.version == "4.1") {
      CHECK(declaration.element_groups.empty());
      continue;
    }
    CHECK(declaration.version == "2.2");
    CHECK(declaration.element_groups ==
          std::unordered_map<std::int64_t, int>{
              {1, 3}, {2, 4}, {3, 1}, {4, 1}, {5, 1}, {6, 2}, {7, 2}, {8, 2}, {9, 2}, {10, 2}, {11, 2}});
  }
}

TEST_CASE("Lines may end as on Windows") {
  std::string text = test::read_file(test::get_data("portal_22.msh")), windows;
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const MshDeclaration declaration = read_msh_declaration(test::write_file("windows.msh", windows));
  CHECK(declaration.num_elements == 11);
  CHECK(declaration.element_groups.at(9) == 2);
}

TEST_CASE("Numbers that no file can have are refused before anything is made of them") {
  const std::string text = test::read_file(test::get_data("portal_22.msh"));
  CHECK(message(test::replace(text, "$Nodes\n9\n", "$Nodes\n99999999999\n")) ==
        fmt::format("declaration.msh: error: $Nodes: declares 99999999999 nodes, but the file has {} bytes",
                    text.size() + 10));
  CHECK(message(test::replace(text, "$Elements\n11\n", "$Elements\n-1\n")) ==
        fmt::format("declaration.msh: error: $Elements: declares -1 elements, but the file has {} bytes",
                    text.size()));
  CHECK(message(test::replace(text, "4 1 2 1 1 4 5", "4 1 2 4294967297 1 4 5")) ==
        "declaration.msh: error: $Elements: physical group 4294967297 is out of range, expected up to "
        "2147483647");
}

TEST_CASE("Lines beyond the declared number are not left out without a word") {
  const std::string text = test::read_file(test::get_data("portal_22.msh"));
  for (const std::string section : {"Nodes", "Elements"}) {
    const std::size_t at = text.find("$" + section + "\n") + section.size() + 2;
    const std::size_t end = text.find('\n', at);
    const int declared = std::stoi(text.substr(at, end - at));
    const std::string what = section == "Nodes" ? "nodes" : "elements";
    for (const int other : {declared - 1, declared + 1}) {
      CHECK(message(text.substr(0, at) + std::to_string(other) + text.substr(end)) ==
            fmt::format("declaration.msh: error: ${}: declares {} {}, but has lines for {}", section, other,
                        what, declared));
    }
  }
}

TEST_CASE("A file that is no complete gmsh mesh is refused") {
  const std::string text = test::read_file(test::get_data("portal_22.msh"));
  const std::string binary = test::read_file(test::get_data("portal_22_binary.msh"));
  CHECK(message("") == "declaration.msh: error: the file is empty");
  CHECK(message("solid cube\n") ==
        "declaration.msh: error: not a gmsh mesh: the first line is not $MeshFormat");
  CHECK(message(test::replace(text, "2.2 0 8", "4.0 0 8")) ==
        "declaration.msh: error: mesh format is 4.0, expected 2.2 or 4.1");
  CHECK(message(test::replace(text, "2.2 0 8", "2.2 0 4")) ==
        "declaration.msh: error: $MeshFormat: data size is 4, expected 8");
  CHECK(message(test::replace(text, "2.2 0 8", "2.2 x 8")) ==
        "declaration.msh: error: $MeshFormat: expected a whole number");
  CHECK(message(test::replace(binary, std::string("\x01\0\0\0", 4), std::string("\0\0\0\x01", 4))) ==
        "declaration.msh: error: $MeshFormat: the file was written with another byte order");
  CHECK(message(text.substr(0, text.find("$Nodes"))) ==
        "declaration.msh: error: no section $Nodes; the file is truncated or has no mesh");
  CHECK(message(text.substr(0, text.find("$EndNodes"))) ==
        "declaration.msh: error: the file is truncated: section $Nodes has no $EndNodes");
  CHECK(message(text.substr(0, text.find("$EndElements"))) ==
        "declaration.msh: error: the file is truncated: section $Elements has no $EndElements");
  CHECK(message(test::replace(text, "$Elements\n11\n1 15 2", "$Elements\n11\n1 15 two")) ==
        "declaration.msh: error: $Elements: expected a whole number");
  const std::size_t end = binary.find("$EndElements");
  CHECK(message(binary.substr(0, end - 30) + binary.substr(end)) ==
        "declaration.msh: error: $Elements: truncated");
}

TEST_CASE("A missing mesh file, and a folder, are refused") {
  test::check_contains(
      test::message_of<support::InputError>([] { read_msh_declaration("no_such_file.msh"); }),
      "no_such_file.msh: error: ");
  test::check_contains(
      test::message_of<support::InputError>([] { read_msh_declaration(test::get_data("")); }), ": error: ");
}

}  // namespace sprung::fem

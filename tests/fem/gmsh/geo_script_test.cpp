#include "fem/gmsh/geo_script.h"

#include <array>
#include <string>

#include "tests/catch.h"

namespace sprung::fem {

namespace {

// `word line:column` of the first statement that writes, or "".
std::string find_writing(std::string_view text) {
  const std::optional<GeoStatement> found = find_writing_statement(text);
  if (!found) return {};
  return std::string(found->word) + " " + std::to_string(found->line) + ":" + std::to_string(found->column);
}

}  // namespace

// Statements of the Gmsh reference manual 4.8, "General commands" and "Post-processing commands".
TEST_CASE("Statements that write a file or run a program are found, with their place") {
  CHECK(find_writing("Save \"x.msh\";") == "Save 1:1");
  CHECK(find_writing("Mesh 1;\n  Save StrCat(name, \".msh\");\n") == "Save 2:3");
  CHECK(find_writing("For i In {0:1} Save \"x.msh\"; EndFor") == "Save 1:16");
  CHECK(find_writing("/* a\n b */ Save 'x.msh';") == "Save 2:7");
  CHECK(find_writing("Save View[0] \"x.pos\";") == "Save 1:1");
  CHECK(find_writing("Save // the mesh\n \"x.msh\";") == "Save 1:1");
  CHECK(find_writing("Print \"x.png\";") == "Print 1:1");
  CHECK(find_writing("SystemCall \"rm x\";") == "SystemCall 1:1");
  CHECK(find_writing("System \"rm x\";") == "System 1:1");
  CHECK(find_writing("NonBlockingSystemCall \"rm x\";") == "NonBlockingSystemCall 1:1");
  CHECK(find_writing("a = 1;OnelabRun(\"name\", \"program\");") == "OnelabRun 1:7");
  CHECK(find_writing("Plugin(SpanningTree).Run;") == "Plugin 1:1");
  CHECK(find_writing("Printf(\"%g (m)\", a(0)) > \"x.txt\";") == "Printf 1:1");
  CHECK(find_writing("Printf(\"a\") >> \"x.txt\";") == "Printf 1:1");
  CHECK(find_writing("CreateDir \"x\";") == "CreateDir 1:1");
  CHECK(find_writing("Field[1] = ExternalProcess;\nField[1].CommandLine = \"x\";") == "ExternalProcess 1:12");
}

// gmsh 4.8 made five elements of a curve whose count of ten stood in such a place.
TEST_CASE("Statements behind the first one of a last line without an end are found") {
  const auto find = [](std::string_view text) {
    const std::optional<GeoStatement> found = find_dropped_statement(text);
    return found ? std::to_string(found->line) + ":" + std::to_string(found->column) : std::string();
  };
  CHECK(find("a = 1;\nx = 3; Transfinite Curve{1} = 11;") == "2:8");
  CHECK(find("x = 3; y = 4") == "1:8");
  for (const char* text :
       {"", "a = 1;", "a = 1; b = 2;\n", "a = 1; b = 2;\nc = 3; // the last; one", "// a; b; c"})
    CHECK(find(text).empty());
}

TEST_CASE("Options, comments, strings and names that resemble such statements are none") {
  for (const char* text :
       {"", "Save", "Print.Background = 1;", "Mesh.SaveAll = 1;", "// Save \"x.msh\";\na = 1;",
        "/*\nSave \"x.msh\";\n*/", "Physical Curve(\"Save \") = {1};", "Physical Curve(\"\nSave \") = {1};",
        "Saved \"x\";", "Printf(\"a > b\");", "Printf(\"a\"", "b = a > 2;", "Save = 3;",
        "General.Save \"x\";"}) {
    INFO(text);
    CHECK(find_writing(text).empty());
  }
}

TEST_CASE("Statements are found by their words") {
  constexpr std::array<std::string_view, 2> kWords = {"Include", "Merge"};
  const std::optional<GeoStatement> found = find_geo_statement("a = 1;\n\tMerge \"b.geo\";", kWords);
  REQUIRE(found);
  CHECK(found->word == "Merge");
  CHECK(found->line == 2);
  CHECK(found->column == 2);
  CHECK(!find_geo_statement("Merged = 1; // Include \"b.geo\"", kWords));
  constexpr std::array<std::string_view, 3> kOthers = {"GetEnv", "ListFromFile", "FileName"};
  for (const char* text : {"If (StrCmp(GetEnv(\"L\"), \"\")) EndIf", "L[] = ListFromFile(\"a.txt\");",
                           "Field[1].FileName = \"a.txt\";"})
    CHECK(find_geo_statement(text, kOthers));
}

}  // namespace sprung::fem

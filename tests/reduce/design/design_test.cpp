#include "reduce/design/design.h"

#include <cmath>
#include <filesystem>

#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/files/content_hash.h"

namespace sprung::reduce {
namespace {

using support::InputError;
using testing::message_of;

// A portal: two legs and a beam, a mass in the middle of the beam.
const std::string kDesign = R"(name = "portal"
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.leg]
material = "steel"
area = 1.0e-3
second_moment = 2.0e-7
[sections.beam]
material = "steel"
area = 2.0e-3
second_moment = 8.0e-7
[points]
foot = [0.0, 0.0]
left = [0.1, 1.5]
right = [2.1, 1.5]
end = [2.2, 0.1]
seat = [1.1, 1.5]
[[lines]]
through = ["foot", "left", "right"]
section = "leg"
elements = [3, 4]
[[lines]]
from = "right"
to = "end"
section = "beam"
elements = 2
[[point_masses]]
point = "seat"
mass = 20.0
inertia = 0.5
[reference]
point = "foot"
[modes]
count = 5
damping_ratio = 0.015
)";

Design read(const std::string& text) {
  testing::write_text("portal.toml", text);
  return read_design("portal.toml");
}

// The design with the first occurrence of a text replaced.
std::string change(const std::string& from, const std::string& to) {
  std::string text = kDesign;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string fault(const std::string& from, const std::string& to) {
  return message_of<InputError>([&] { read(change(from, to)); });
}

TEST_CASE("a design's mesh, sections, masses, reference and modes are as written") {
  const Design design = read(kDesign);
  const fem::Mesh& mesh = design.model.mesh;
  CHECK(design.name == "portal");
  CHECK(mesh.num_elements() == 9);
  CHECK(mesh.num_nodes() == 10);
  CHECK(design.reference_node == fem::find_node(mesh, "foot"));
  const int seat = fem::find_node(mesh, "seat");
  REQUIRE(seat >= 0);
  CHECK((mesh.node_positions.col(seat) - Eigen::Vector2d(1.1, 1.5)).norm() < 1e-12);
  REQUIRE(design.model.point_masses.size() == 1);
  CHECK(design.model.point_masses[0].node == seat);
  CHECK(design.model.point_masses[0].inertia == 0.5);
  CHECK(std::get<ModeCount>(design.modes.wanted).count == 5);
  CHECK(design.damping_ratio == std::vector<double>{0.015});
  for (const fem::Mesh::Element& element : mesh.elements) {
    const bool upright = mesh.section_names[static_cast<std::size_t>(element.section)] == "beam";
    const double middle =
        0.5 * (mesh.node_positions(0, element.first) + mesh.node_positions(0, element.second));
    CHECK(upright == (middle > 2.1));
    CHECK(design.model.sections[static_cast<std::size_t>(element.section)].axial_rigidity ==
          Approx(2.1e11 * (upright ? 2.0e-3 : 1.0e-3)));
  }
  CHECK(design.provenance.design_text == kDesign);
  CHECK(design.provenance.design_hash == support::sha256(kDesign));
  CHECK(design.provenance.input_names.empty());
}

TEST_CASE("a design's superelement has the mass and inertia that its lines add up to") {
  const Superelement s = make_superelement(read(kDesign));
  const double leg = 7.85 * std::hypot(0.1, 1.5), beam = 7.85 * 2.0, other = 15.7 * std::hypot(0.1, 1.4);
  CHECK(s.inertia.mass == Approx(leg + beam + other + 20.0).epsilon(1e-12));
  CHECK(s.inertia.first_moment.x() ==
        Approx(leg * 0.05 + beam * 1.1 + other * 2.15 + 20.0 * 1.1).epsilon(1e-12));
  CHECK(s.inertia.first_moment.y() ==
        Approx(leg * 0.75 + beam * 1.5 + other * 0.8 + 20.0 * 1.5).epsilon(1e-12));
  const double second =
      leg * std::pow(std::hypot(0.1, 1.5), 2) / 3.0 + beam * (4.0 / 12.0 + 1.1 * 1.1 + 1.5 * 1.5) +
      other * ((0.01 + 1.96) / 12.0 + 2.15 * 2.15 + 0.8 * 0.8) + 20.0 * (1.1 * 1.1 + 1.5 * 1.5) + 0.5;
  CHECK(s.inertia.second_moment == Approx(second).epsilon(1e-12));
  CHECK(s.num_modes() == 5);
  CHECK(s.num_elastic_dofs == 27);
}

TEST_CASE("modes are asked for by count, frequency, numbers or all") {
  CHECK(
      std::get<ModesUpTo>(read(change("count = 5", "highest_frequency = 80.0")).modes.wanted).frequency_hz ==
      80.0);
  CHECK(std::holds_alternative<AllModes>(read(change("count = 5", "all = true")).modes.wanted));
  CHECK(std::get<ModeNumbers>(read(change("count = 5", "numbers = [4, 1]")).modes.wanted).numbers ==
        std::vector<int>{1, 4});
  CHECK(read(change("damping_ratio = 0.015", "damping_ratio = [0.1, 0.2, 0.3, 0.4, 0.5]"))
            .damping_ratio.size() == 5);
}

TEST_CASE("theory and rotary inertia reach the elements") {
  const std::string text = change("name = \"portal\"", "theory = \"timoshenko\"\nrotary_inertia = true");
  const std::string steel = "density = 7850.0";
  std::string complete = text;
  complete.replace(complete.find(steel), steel.size(), steel + "\npoissons_ratio = 0.3");
  for (int i = 0, at = 0; i < 2; ++i) {
    at = static_cast<int>(complete.find("second_moment", static_cast<std::size_t>(at)));
    const std::string extra = "shear_coefficient = 0.5\n";
    complete.insert(static_cast<std::size_t>(at), extra);
    at += static_cast<int>(extra.size()) + 5;
  }
  const Design design = read(complete);
  CHECK(design.name == "portal");  // the file's
  for (const fem::BeamProperties& section : design.model.sections) {
    CHECK(section.shear_rigidity == Approx(0.5 * section.axial_rigidity / 2.6));
    CHECK(section.rotary_inertia == Approx(7850.0 * section.bending_rigidity / 2.1e11));
  }
}

TEST_CASE("misspelt and unknown keys are named with the nearest known one") {
  CHECK_THAT(fault("[reference]", "[refrence]"),
             Contains("portal.toml:32:") && Contains("unknown key 'refrence' (did you mean 'reference'?)"));
  CHECK_THAT(
      fault("density", "densty"),
      Contains(
          "portal.toml:4:1: error: unknown key 'densty' in 'materials.steel' (did you mean 'density'?)"));
  CHECK_THAT(fault("mass = 20.0", "masss = 20.0"),
             Contains("unknown key 'masss'") && Contains("did you mean 'mass'?"));
  CHECK_THAT(fault("count = 5", "cuont = 5"),
             Contains("unknown key 'cuont' in 'modes' (did you mean 'count'?)"));
  CHECK_THAT(fault("elements = 2", "element = 2"),
             Contains("unknown key 'element'") && Contains("did you mean 'elements'?"));
  CHECK_THAT(fault("name = \"portal\"", "titel = \"portal\""), Contains("unknown key 'titel'"));
}

TEST_CASE("missing keys are named with their table") {
  CHECK_THAT(fault("elements = 2\n", ""), Contains("missing key 'elements'"));
  CHECK_THAT(fault("damping_ratio = 0.015", ""), Contains("missing key 'damping_ratio' in 'modes'"));
  CHECK_THAT(fault("section = \"beam\"", ""), Contains("missing key 'section'"));
  CHECK_THAT(fault("[reference]\npoint = \"foot\"", ""), Contains("missing key 'reference'"));
  CHECK_THAT(
      fault("count = 5", ""),
      Contains("'modes' has 0 of the keys 'count', 'highest_frequency', 'all' and 'numbers', expected one"));
}

TEST_CASE("wrong types and values out of range are located") {
  CHECK_THAT(fault("count = 5", "count = \"five\""), Contains("portal.toml:35:9: error: 'modes.count'"));
  CHECK_THAT(fault("count = 5", "count = 0"), Contains("'modes.count'"));
  CHECK_THAT(fault("count = 5", "count = 5\nall = true"), Contains("has 2 of the keys"));
  CHECK_THAT(fault("count = 5", "all = false"), Contains("'modes.all' is false"));
  CHECK_THAT(fault("count = 5", "numbers = []"), Contains("'modes.numbers' is empty"));
  CHECK_THAT(fault("count = 5", "numbers = [2, 2]"), Contains("names a mode twice"));
  CHECK_THAT(fault("count = 5", "highest_frequency = -3.0"),
             Contains("'modes.highest_frequency' must be > 0 Hz"));
  CHECK_THAT(fault("damping_ratio = 0.015", "damping_ratio = -0.1"), Contains("'modes.damping_ratio'"));
  CHECK_THAT(fault("damping_ratio = 0.015", "damping_ratio = nan"), Contains("'modes.damping_ratio'"));
  CHECK_THAT(fault("mass = 20.0", "mass = -20.0"),
             Contains("'point_masses.0.mass'") && Contains("≥ 0 and ≤ 1e+24 kg, got -20"));
  CHECK_THAT(fault("left = [0.1, 1.5]", "left = [0.1]"), Contains("'points.left'"));
  CHECK_THAT(fault("left = [0.1, 1.5]", "left = [0.1, inf]"), Contains("points.left"));
  CHECK_THAT(fault("elements = [3, 4]", "elements = [3, 4, 5]"),
             Contains("has 3 numbers for the line's 2 segments"));
  CHECK_THAT(fault("elements = 2", "elements = 0"), Contains("elements'"));
  CHECK_THAT(fault("point = \"foot\"", "point = \"foot\"\ncondition = \"hinged\""),
             Contains("'reference.condition'"));
  CHECK_THAT(fault("name = \"portal\"", "theory = \"timoschenko\""), Contains("timoshenko"));
}

TEST_CASE("unknown materials, sections and points are named with the nearest known one") {
  CHECK_THAT(fault("section = \"beam\"", "section = \"baem\""),
             Contains("names the section 'baem', which is not defined (did you mean 'beam'?)"));
  CHECK_THAT(fault("from = \"right\"", "from = \"rihgt\""),
             Contains("portal.toml:24:8: error:") &&
                 Contains("names the point 'rihgt', which is not defined (did you mean 'right'?)"));
  CHECK_THAT(fault("point = \"seat\"", "point = \"seet\""),
             Contains("names the point 'seet', which is not defined (did you mean 'seat'?)"));
  CHECK_THAT(fault("point = \"foot\"", "point = \"fot\""),
             Contains("'reference.point' names the point 'fot'"));
}

TEST_CASE("a point must be at a node") {
  CHECK_THAT(
      fault("seat = [1.1, 1.5]", "seat = [1.1, 1.6]"),
      Contains(
          "portal.toml:18:8: error: point 'seat' at (1.1, 1.6) lies on no line: the nearest is 0.1 m away"));
  CHECK_THAT(fault("seat = [1.1, 1.5]", "seat = [1.2, 1.5]"),
             Contains("point 'seat' at (1.2, 1.5) lies on a line, but 0.1 m from its nearest node; let the "
                      "line pass 'through' it"));
}

TEST_CASE("a frame in two parts is refused, naming the nodes of one") {
  const std::string parts = "end = [2.2, 0.1]\nfar = [5.0, 5.0]\nfarther = [6.0, 5.0]";
  std::string text = change("end = [2.2, 0.1]", parts);
  text.insert(text.find("[[point_masses]]"),
              "[[lines]]\nfrom = \"far\"\nto = \"farther\"\nsection = \"leg\"\nelements = 1\n");
  CHECK_THAT(message_of<InputError>([&] { read(text); }), Contains("far"));
}

TEST_CASE("lines given in two ways or not at all are refused") {
  CHECK_THAT(fault("from = \"right\"", "from = \"right\"\nthrough = [\"right\", \"end\"]"),
             Contains("has 'through' beside 'from' or 'to'"));
  CHECK_THAT(fault("through = [\"foot\", \"left\", \"right\"]", "through = [\"foot\"]"),
             Contains("names 1 points, expected at least 2"));
  CHECK_THAT(fault("name = \"portal\"", "mesh = \"portal.geo\""),
             Contains("stands beside 'mesh'; give either"));
}

TEST_CASE("a design that cannot be read says why") {
  CHECK_THAT(message_of<InputError>([] { read_design("no-such-design.toml"); }),
             Contains("no-such-design.toml: error: "));
  CHECK_THAT(message_of<InputError>([] { read("name = \"a\nb"); }), Contains("portal.toml:1:"));
}

const std::string kMeshDesign = R"(mesh = "bar.geo"
[materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.thick]
material = "steel"
area = 2.0e-3
second_moment = 8.0e-7
[sections.thin]
material = "steel"
area = 1.0e-3
second_moment = 2.0e-7
[points]
quarter = [0.5, 0.0]
[reference]
point = "root"
[modes]
all = true
damping_ratio = 0.0
)";
const std::string kGeo = R"(Point(1) = {0, 0, 0};
Point(2) = {1, 0, 0};
Point(3) = {1.5, 0.5, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Transfinite Curve {1} = 5;
Transfinite Curve {2} = 3;
Physical Point("root") = {1};
Physical Point("tip") = {3};
Physical Curve("thick") = {1};
Physical Curve("thin") = {2};
)";

TEST_CASE("a gmsh file gives mesh, sections and points, and its hash is kept") {
  testing::write_text("bar.geo", kGeo);
  const Design design = read(kMeshDesign);
  CHECK(design.model.mesh.num_elements() == 6);
  CHECK(design.provenance.input_names == std::vector<std::string>{"bar.geo"});
  CHECK(design.provenance.input_hashes == std::vector<std::string>{support::sha256(kGeo)});
  CHECK(fem::find_node(design.model.mesh, "quarter") >= 0);
  const Superelement s = make_superelement(design);
  CHECK(s.inertia.mass == Approx(15.7 * 1.0 + 7.85 * std::hypot(0.5, 0.5)).epsilon(1e-12));
  CHECK(find_point(s, "tip") >= 0);
  CHECK(s.node_positions.col(find_point(s, "tip")).isApprox(Eigen::Vector2d(1.5, 0.5), 1e-12));
}

TEST_CASE("faults between a design and its gmsh file are named") {
  const auto geo_fault = [](const std::string& from, const std::string& to) {
    std::string text = kGeo;
    text.replace(text.find(from), from.size(), to);
    testing::write_text("bar.geo", text);
    return message_of<InputError>([] { read(kMeshDesign); });
  };
  CHECK_THAT(
      geo_fault("\"thin\"", "\"thinn\""),
      Contains("bar.geo: error: physical curve 'thinn' is no section of the design (did you mean 'thin'?)"));
  CHECK_THAT(geo_fault("Physical Point(\"root\") = {1};", ""),
             Contains("'reference.point' names the point 'root'"));
  CHECK_THAT(geo_fault("\"tip\"", "\"quarter\""), Contains("point 'quarter' is named in 'bar.geo' already"));
  CHECK_THAT(geo_fault("Point(1)", "Include \"other.geo\";\nPoint(1)"),
             Contains("bar.geo:1:1: error: 'Include' reads another file"));
  CHECK_THAT(geo_fault("Point(1)", "a = 1;  Merge \"other.msh\";\nPoint(1)"),
             Contains("bar.geo:1:9: error: 'Merge' reads another file"));
  // A name that begins like the statement, and a comment.
  testing::write_text("bar.geo", "IncludedLength = 1; // Include nothing\n" + std::string(kGeo));
  CHECK_NOTHROW(read(kMeshDesign));
  std::filesystem::remove("bar.geo");
  CHECK_THAT(message_of<InputError>([] { read(kMeshDesign); }),
             Contains("portal.toml:1:8: error: 'mesh' must name a file, found none at 'bar.geo'"));
}

TEST_CASE("a mesh so fine that rounding errors dominate the lowest mode is refused with the number") {
  const std::string text = change("elements = [3, 4]", "elements = [6000, 8000]");
  CHECK_THAT(message_of<support::NumericalError>([&] { make_superelement(read(text)); }),
             Contains("rounding spoils the lowest mode") || Contains("not positive definite to rounding"));
  CHECK_THAT(message_of<support::NumericalError>(
                 [&] { make_superelement(read(change("elements = [3, 4]", "elements = [1500, 2000]"))); }),
             Contains("its relative error in ω² is about") && Contains("accepted is 1e-04"));
}

}  // namespace
}  // namespace sprung::reduce

#include "reduce/design/design_sections.h"

#include <cmath>
#include <numbers>

#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using support::InputError;
using testing::message_of;

Sections read(const std::string& section,
              const std::string& material = "youngs_modulus = 2.0e11\ndensity = 8000.0",
              const BeamTheory& theory = {}) {
  const support::TomlDocument document = support::TomlDocument::parse(
      "[materials.steel]\n" + material + "\n[sections.s]\nmaterial = \"steel\"\n" + section, "d.toml");
  return read_sections(document.root(), read_materials(document.root()), theory);
}

std::string fault(const std::string& section,
                  const std::string& material = "youngs_modulus = 2.0e11\ndensity = 8000.0",
                  const BeamTheory& theory = {}) {
  return message_of<InputError>([&] { read(section, material, theory); });
}

// Area and second moment of the section, from its rigidities with E = 2e11 Pa.
void check_geometry(const std::string& text, double area, double second_moment) {
  const fem::BeamProperties section = read(text).at("s");
  CAPTURE(text);
  CHECK(section.axial_rigidity == Approx(2.0e11 * area).epsilon(1e-13));
  CHECK(section.bending_rigidity == Approx(2.0e11 * second_moment).epsilon(1e-13));
  CHECK(section.mass_per_length == Approx(8000.0 * area).epsilon(1e-13));
  CHECK(std::isinf(section.shear_rigidity));
  CHECK(section.rotary_inertia == 0.0);
}

TEST_CASE("sections by shape have the area and second moment calculated by hand") {
  check_geometry("shape = \"rectangle\"\nwidth = 0.05\nheight = 0.12", 6.0e-3,
                 0.05 * 0.12 * 0.12 * 0.12 / 12.0);
  // 100 × 200 × 10: 20000 − 80·180 mm², (100·200³ − 80·180³)/12 mm⁴
  check_geometry("shape = \"box\"\nwidth = 0.1\nheight = 0.2\nwall = 0.01", 5.6e-3, 27786666.6666666667e-12);
  // 60 × 3: π/4 (60² − 54²) mm², π/64 (60⁴ − 54⁴) mm⁴
  check_geometry("shape = \"tube\"\nouter_diameter = 0.06\nwall = 0.003", std::numbers::pi / 4.0 * 684e-6,
                 std::numbers::pi / 64.0 * (12960000.0 - 8503056.0) * 1e-12);
  // 200 high, flanges 100 × 10, web 6: 2000 + 180·6 mm², (100·200³ − 94·180³)/12 mm⁴
  check_geometry(
      "shape = \"i_section\"\nheight = 0.2\nflange_width = 0.1\nflange_thickness = 0.01\nweb_thickness = "
      "0.006",
      3.08e-3, 20982666.6666666667e-12);
  check_geometry("area = 1.5e-3\nsecond_moment = 2.5e-6", 1.5e-3, 2.5e-6);
}

TEST_CASE("parallel members count in stiffness, mass and rotary inertia") {
  const BeamTheory theory{.shear_deformation = true, .rotary_inertia = true};
  const std::string steel = "youngs_modulus = 2.0e11\ndensity = 8000.0\npoissons_ratio = 0.25";
  const std::string box = "shape = \"box\"\nwidth = 0.1\nheight = 0.2\nwall = 0.01";
  const fem::BeamProperties one = read(box, steel, theory).at("s");
  const fem::BeamProperties two = read(box + "\ncount = 2", steel, theory).at("s");
  CHECK(two.axial_rigidity == 2.0 * one.axial_rigidity);
  CHECK(two.bending_rigidity == 2.0 * one.bending_rigidity);
  CHECK(two.shear_rigidity == 2.0 * one.shear_rigidity);
  CHECK(two.mass_per_length == 2.0 * one.mass_per_length);
  CHECK(two.rotary_inertia == 2.0 * one.rotary_inertia);
  CHECK(two.area == 2.0 * one.area);
  CHECK(two.section_modulus == 2.0 * one.section_modulus);
  CHECK(one.area == Approx(5.6e-3));
  CHECK(one.section_modulus == Approx(27786666.6666666667e-12 / 0.1));  // half the height
  CHECK(one.rotary_inertia == Approx(8000.0 * 27786666.6666666667e-12));
}

TEST_CASE("a section without a shape has the section modulus given, or none") {
  const std::string general = "area = 2.0e-3\nsecond_moment = 1.0e-6\n";
  CHECK(read(general).at("s").section_modulus == 0.0);
  CHECK(read(general + "section_modulus = 3.0e-5\ncount = 2").at("s").section_modulus == 6.0e-5);
  CHECK_THAT(fault(general + "section_modulus = 0.0"),
             Contains("'sections.s.section_modulus' must be > 0 m³, got 0"));
  CHECK_THAT(fault("shape = \"rectangle\"\nwidth = 0.1\nheight = 0.2\nsection_modulus = 1e-4"),
             Contains("unknown key 'section_modulus'"));
}

TEST_CASE("mass per length replaces that of the density, and the shear coefficient that of the shape") {
  const BeamTheory theory{.shear_deformation = true, .rotary_inertia = true};
  const fem::BeamProperties section =
      read("area = 2.0e-3\nsecond_moment = 1.0e-6\nmass_per_length = 30.0\nshear_coefficient = 0.5",
           "youngs_modulus = 2.0e11\npoissons_ratio = 0.25", theory)
          .at("s");
  CHECK(section.mass_per_length == 30.0);
  CHECK(section.rotary_inertia == Approx(30.0 * 1.0e-6 / 2.0e-3));
  CHECK(section.shear_rigidity == Approx(0.5 * 8.0e10 * 2.0e-3));
}

TEST_CASE("sizes that no structure has are refused where they stand") {
  CHECK_THAT(fault("area = 1e25\nsecond_moment = 1.0"),
             Contains("d.toml:6:8: error: 'sections.s.area' must be 1e-24 … 1e+24 m², got 1e+25"));
  CHECK_THAT(fault("area = 1.0\nsecond_moment = 1e-49"),
             Contains("'sections.s.second_moment' must be 1e-48"));
  CHECK_THAT(fault("shape = \"rectangle\"\nwidth = 1e10\nheight = 0.1"),
             Contains("'sections.s.width' must be"));
  CHECK_THAT(fault("area = 1.0\nsecond_moment = 1.0", "youngs_modulus = 1e19\ndensity = 1.0"),
             Contains("'materials.steel.youngs_modulus' must be 1e-06 … 1e+18 Pa, got 1e+19"));
  // 1 - (1 - 2·10⁻¹²/10⁹)⁴ is nothing in doubles
  CHECK_THAT(fault("shape = \"tube\"\nouter_diameter = 1e9\nwall = 1e-12"),
             Contains("rounding leaves nothing of walls as thin as these"));
}

TEST_CASE("a missing or superfluous key of a section or material is named") {
  const std::string general = "area = 2.0e-3\nsecond_moment = 1.0e-6\n";
  const BeamTheory timoshenko{.shear_deformation = true};
  CHECK_THAT(fault("area = 2.0e-3"), Contains("missing key 'second_moment' in 'sections.s'"));
  CHECK_THAT(fault("area = -2.0e-3\nsecond_moment = 1.0"),
             Contains("d.toml:6:8: error: 'sections.s.area' must be > 0 m², got -"));
  CHECK_THAT(fault(general + "count = 0"), Contains("'sections.s.count'"));
  CHECK_THAT(fault(general + "hight = 0.1"), Contains("unknown key 'hight' in 'sections.s'"));
  CHECK_THAT(fault("shape = \"box\"\nwidth = 0.1\nhieght = 0.2\nwall = 0.01"),
             Contains("unknown key 'hieght' in 'sections.s' (did you mean 'height'?)"));
  CHECK_THAT(fault("shape = \"bocks\""), Contains("'sections.s.shape'"));
  CHECK_THAT(fault("shape = \"box\"\nwidth = 0.1\nheight = 0.2\nwall = 0.01\narea = 1.0"),
             Contains("unknown key 'area'"));
  CHECK_THAT(fault("shape = \"box\"\nwidth = 0.1\nheight = 0.2\nwall = 0.06"),
             Contains("'sections.s' is no possible section"));
  CHECK_THAT(fault(general, "youngs_modulus = 2.0e11"),
             Contains("needs 'mass_per_length', because material 'steel' has no 'density'"));
  CHECK_THAT(fault(general, "youngs_modulus = -1.0\ndensity = 8000.0"),
             Contains("'materials.steel.youngs_modulus' must be > 0 Pa"));
  CHECK_THAT(fault(general, "youngs_modulus = 1.0\ndensity = nan"), Contains("'materials.steel.density'"));
  CHECK_THAT(fault(general, "youngs_modulus = inf\ndensity = 1.0"),
             Contains("'materials.steel.youngs_modulus'"));
  CHECK_THAT(fault(general, "youngs_modulus = 1.0\npoissons_ratio = 0.6"),
             Contains("'materials.steel.poissons_ratio' must be"));
  CHECK_THAT(fault(general, "young_modulus = 1.0"),
             Contains("unknown key 'young_modulus' in 'materials.steel' (did you mean 'youngs_modulus'?)"));
  CHECK_THAT(fault(general, "youngs_modulus = 2.0e11\ndensity = 8000.0", timoshenko),
             Contains("needs 'poissons_ratio' of material 'steel'"));
  CHECK_THAT(fault(general, "youngs_modulus = 2.0e11\ndensity = 8000.0\npoissons_ratio = 0.3", timoshenko),
             Contains("needs 'shear_coefficient' for the Timoshenko theory, or a 'shape'"));
}

TEST_CASE("a section's material must exist") {
  const support::TomlDocument document = support::TomlDocument::parse(
      "[materials.steel]\nyoungs_modulus = 1.0\n[sections.s]\nmaterial = \"stele\"\narea = "
      "1.0\nsecond_moment = 1.0",
      "d.toml");
  const Materials materials = read_materials(document.root());
  CHECK_THAT(message_of<InputError>([&] { read_sections(document.root(), materials, {}); }),
             Contains("d.toml:4:12: error: 'sections.s.material' names the material 'stele', which is not "
                      "defined (did you mean 'steel'?)"));
}

}  // namespace
}  // namespace sprung::reduce

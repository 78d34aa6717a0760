#include "reduce/design/design_remarks.h"

#include "tests/catch.h"
#include "tests/tools/support/temporary_folder.h"

using namespace sprung;

namespace {

std::vector<std::string> remarks_on(const std::string& modulus, const std::string& density, double length,
                                    const std::string& more = "",
                                    const std::string& size = "area = 0.01\nsecond_moment = 1e-5\n") {
  const TemporaryFolder folder;
  write_bytes(folder / "beam.toml",
              "[materials.steel]\nyoungs_modulus = " + modulus + "\ndensity = " + density +
                  "\n[sections.bar]\nmaterial = \"steel\"\n" + size + more +
                  "[points]\na = "
                  "[0, 0]\nb = [" +
                  std::to_string(length) +
                  ", 0]\n[[lines]]\nthrough = [\"a\", \"b\"]\nsection = \"bar\"\nelements = "
                  "2\n[reference]\npoint = \"a\"\n[modes]\ncount = 1\ndamping_ratio = 0.01\n");
  return reduce::list_design_remarks(reduce::read_design(folder / "beam.toml"));
}

}  // namespace

TEST_CASE("Steel in SI units calls for no remark") {
  CHECK(remarks_on("2.1e11", "7850", 6.0).empty());
}

TEST_CASE("Points that no vehicle can name are remarked on") {
  const TemporaryFolder folder;
  write_bytes(folder / "beam.toml",
              "[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850\n[sections.bar]\nmaterial = "
              "\"steel\"\narea = 0.01\nsecond_moment = 1e-5\n[points]\na = [0, 0]\n\"b 1.é\" = [6.0, "
              "0]\n[[lines]]\nthrough = [\"a\", \"b 1.é\"]\nsection = \"bar\"\nelements = "
              "2\n[reference]\npoint = \"a\"\n[modes]\ncount = 1\ndamping_ratio = 0.01\n");
  CHECK(
      reduce::list_design_remarks(reduce::read_design(folder / "beam.toml")) ==
      std::vector<std::string>{"no vehicle can name the point 'b 1.é': names in it are letters, digits, '_' "
                               "and '-' alone"});
}

TEST_CASE("Moduli, densities and lengths in other units are remarked on") {
  CHECK(remarks_on("210000", "7850", 6.0) ==
        std::vector<std::string>{
            "'materials.steel.youngs_modulus' is 2.1e+05 Pa, softer than rubber; steel has "
            "2.1e11 Pa, which is 210000 MPa"});
  CHECK(remarks_on("2.1e11", "7.85e-5", 6.0) ==
        std::vector<std::string>{
            "'materials.steel.density' is 7.85e-05 kg/m³; steel has 7850 kg/m³, which is 7.85 "
            "g/cm³ or 7.85e-9 t/mm³"});
  CHECK(remarks_on("2.1e11", "7850", 6000.0) ==
        std::vector<std::string>{"the frame is 6000 m long; lengths are in m, not in mm"});
}

TEST_CASE("A section in millimetres, larger than its frame, is remarked on") {
  const auto remarks = [](const std::string& size) { return remarks_on("2.1e11", "7850", 6.0, "", size); };
  // A rectangle of 200 mm by 300 mm: √A = √60000, radius of gyration 300/√12.
  CHECK(
      remarks("shape = \"rectangle\"\nwidth = 200.0\nheight = 300.0\n") ==
      std::vector<std::string>{
          "'sections.bar' has the area of a square of 244.9 m and a radius of gyration of 86.6 m, in a frame "
          "of 6 m; dimensions are in m, not in mm"});
  CHECK(remarks("area = 0.06\nsecond_moment = 4.5e8\n").size() == 1);    // in m² and mm⁴
  CHECK(remarks("area = 600.0\nsecond_moment = 4.5e-4\n").size() == 1);  // in cm² and m⁴
  CHECK(remarks("area = 30.0\nsecond_moment = 4.5e-4\n").empty());
}

TEST_CASE("A section modulus beyond what area and second moment allow is remarked on") {
  // At most √(I A) = √(1e-5 · 0.01) = 3.1623e-4 m³, of two thin flanges without a web.
  CHECK(remarks_on("2.1e11", "7850", 6.0, "section_modulus = 3.16e-4\n").empty());
  CHECK(remarks_on("2.1e11", "7850", 6.0, "section_modulus = 200.0\n") ==
        std::vector<std::string>{
            "'sections.bar.section_modulus' is 200 m³ (parallel members together); a section of this "
            "area and second moment has at most 0.0003162 m³"});
}

TEST_CASE("A line that ends on another one without being joined to it is remarked on") {
  const auto remarks = [](int elements) {
    const TemporaryFolder folder;
    write_bytes(
        folder / "tee.toml",
        "[materials.steel]\nyoungs_modulus = 2.1e11\ndensity = 7850\n[sections.bar]\nmaterial = "
        "\"steel\"\narea = 0.01\nsecond_moment = 1e-5\n[points]\na = [0, 0]\nb = [2, 0]\nm = [0.6, 0]\n"
        "c = [0.6, 1]\nd = [2, 1]\n[[lines]]\nthrough = [\"a\", \"b\", \"d\", \"c\"]\nsection = \"bar\"\n"
        "elements = " +
            std::to_string(elements) +
            "\n[[lines]]\nthrough = [\"c\", \"m\"]\nsection = \"bar\"\nelements = 2\n[reference]\n"
            "point = \"a\"\n[modes]\ncount = 1\ndamping_ratio = 0.01\n");
    return reduce::list_design_remarks(reduce::read_design(folder / "tee.toml"));
  };
  REQUIRE(remarks(4).size() == 1);
  CHECK_THAT(remarks(4)[0], Contains("'m'") && Contains("lies on a line without being joined to it"));
}

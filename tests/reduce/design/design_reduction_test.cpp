#include "reduce/design/design_reduction.h"

#include <fmt/format.h>

#include "reduce/design/design.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

using support::InputError;
using testing::message_of;

const std::string kFrame = R"([materials.steel]
youngs_modulus = 2.1e11
density = 7850.0
[sections.tube]
material = "steel"
area = 1.0e-3
second_moment = 2.0e-7
[points]
left = [0.0, 0.0]
middle = [1.0, 0.0]
right = [2.0, 0.0]
end = [2.0, 0.5]
[[lines]]
through = ["left", "middle", "right", "end"]
section = "tube"
elements = 4
[reference]
point = "middle"
)";

Design read(const std::string& rest) {
  testing::write_text("frame.toml", kFrame + rest);
  return read_design("frame.toml");
}

std::string fault(const std::string& rest) {
  return message_of<InputError>([&] { read(rest); });
}

const std::string kDamping = "[modes]\ndamping_ratio = 0.01\n";
const std::string kCounted = "[modes]\ncount = 4\ndamping_ratio = 0.01\n";
const std::string kFree = kDamping + "[reduction]\nhighest_frequency = 50.0\n";

TEST_CASE("a design that counts modes is one for clamped modes, with and without [reduction]") {
  CHECK(read(kCounted).reduction.basis == BasisKind::kClamped);
  CHECK(read(kCounted + "[reduction]\nhighest_frequency = 50.0\n").reduction.basis == BasisKind::kClamped);
  CHECK(read(kCounted + "[reduction]\nbasis = \"clamped\"\n").reduction.basis == BasisKind::kClamped);
}

TEST_CASE("a design with [reduction] that counts no modes is one for interface loads") {
  const Design design = read(kFree);
  CHECK(design.reduction.basis == BasisKind::kFree);
  CHECK(design.reduction.highest_hz == 50.0);
  CHECK(design.reduction.tolerance == 0.01);
  CHECK_FALSE(design.reduction.all_residual);
  CHECK(read(kFree + "basis = \"fixed-interface\"\n").reduction.basis == BasisKind::kFixedInterface);
  CHECK(read(kFree + "residual_vectors = \"all\"\n").reduction.all_residual);
}

TEST_CASE("without [interface] every named point takes loads, but the reference") {
  const std::vector<InterfaceFreedom> interface = read(kFree).reduction.interface;
  REQUIRE(interface.size() == 9);
  const fem::Mesh mesh = read(kFree).model.mesh;
  for (std::size_t j = 0; j < 9; ++j) {
    CHECK(mesh.named_nodes[static_cast<std::size_t>(interface[j].point)].name != "middle");
    CHECK(interface[j].freedom == static_cast<int>(j % 3));
  }
}

TEST_CASE("[interface] names points and freedoms, the reference too; r and ψ are the rotation") {
  const Design design = read(kFree + "[interface]\nleft = \"ry\"\nmiddle = \"xψ\"\n");
  std::vector<std::pair<std::string, int>> found;
  for (const InterfaceFreedom& one : design.reduction.interface) {
    found.emplace_back(design.model.mesh.named_nodes[static_cast<std::size_t>(one.point)].name, one.freedom);
  }
  CHECK(found ==
        std::vector<std::pair<std::string, int>>{{"left", 1}, {"left", 2}, {"middle", 0}, {"middle", 2}});
}

TEST_CASE("what [interface], [reduction] and [modes] cannot say is located") {
  CHECK_THAT(fault(kFree + "[interface]\nleft = \"xz\"\n"),
             Contains("frame.toml:24:8: error: 'interface.left' is 'xz', expected the letters x, y and r"));
  CHECK_THAT(fault(kFree + "[interface]\nleft = \"xx\"\n"), Contains("each at most once"));
  CHECK_THAT(fault(kFree + "[interface]\nleft = \"\"\n"), Contains("'interface.left' is empty"));
  CHECK_THAT(fault(kFree + "[interface]\nlift = \"x\"\n"),
             Contains("unknown key 'lift'") && Contains("did you mean 'left'?"));
  CHECK_THAT(fault(kFree + "[interface]\n"), Contains("'interface' is empty"));
  CHECK_THAT(fault(kDamping + "[reduction]\nbasis = \"free\"\n"),
             Contains("missing key 'highest_frequency' in 'reduction'"));
  CHECK_THAT(fault(kFree + "basis = \"held\"\n"), Contains("'reduction.basis'") && Contains("clamped"));
  CHECK_THAT(fault(kFree + "tolerance = 1e-9\n"), Contains("'reduction.tolerance'"));
  CHECK_THAT(fault(kDamping + "[reduction]\nhighest_frequency = 1e-20\n"),
             Contains("'reduction.highest_frequency' must be 1e-15 … 1e+09 Hz, got 1e-20"));
  CHECK_THAT(fault(kFree + "modes = 3\n"), Contains("unknown key 'modes'"));
  CHECK_THAT(fault(kCounted + "[reduction]\nbasis = \"free\"\nhighest_frequency = 50.0\n"),
             Contains("'modes.count' belongs to the basis \"clamped\""));
  CHECK_THAT(fault(kCounted + "[reduction]\ntolerance = 0.01\n"),
             Contains("'reduction.tolerance' belongs to the basis \"free\" alone"));
  CHECK_THAT(
      fault(kDamping + "[reduction]\nbasis = \"clamped\"\n"),
      Contains("'modes' has 0 of the keys 'count', 'highest_frequency', 'all' and 'numbers', expected one"));
  CHECK_THAT(fault(kDamping), Contains("expected one, or a table [reduction] beside it"));
  CHECK_THAT(fault(kCounted + "residual_damping_ratio = 0.02\n"),
             Contains("'modes.residual_damping_ratio' belongs to the basis \"free\" alone"));
}

TEST_CASE("a basis for more interface loads than a file can hold is refused at once") {
  std::string points, through = "\"p0\"";
  for (int i = 0; i <= 334; ++i) points += fmt::format("p{} = [{}.0, 0.0]\n", i, i);
  for (int i = 1; i <= 334; ++i) through += fmt::format(", \"p{}\"", i);
  const auto message = [&](const std::string& rest) {
    testing::write_text("long.toml",
                        kFrame.substr(0, kFrame.find("[points]")) + "[points]\n" + points +
                            "[[lines]]\nthrough = [" + through +
                            "]\nsection = \"tube\"\nelements = 1\n[reference]\npoint = \"p0\"\n" + rest);
    return message_of<InputError>([] { read_design("long.toml"); });
  };
  CHECK_THAT(
      message(kFree),
      Contains(
          "error: 'reduction' asks for a basis for 1002 freedoms of named points, expected at most 1000"));
  CHECK(message(kFree + "[interface]\np334 = \"xyr\"\n") == "nothing was thrown");
  CHECK(message(kCounted) == "nothing was thrown");
}

TEST_CASE("residual vectors have the ratio of their own key, or that of the free modes") {
  const auto ratios = [](const std::string& modes) {
    return make_superelement(read(modes + "[reduction]\nhighest_frequency = 100.0\n")).damping_ratio;
  };
  const Eigen::VectorXd same = ratios("[modes]\ndamping_ratio = 0.02\n");
  CHECK(same.isConstant(0.02));
  const Superelement body =
      make_superelement(read("[modes]\ndamping_ratio = 0.02\nresidual_damping_ratio = "
                             "0.5\n[reduction]\nhighest_frequency = 100.0\n"));
  REQUIRE(body.kind.front() == kFreeVector);
  REQUIRE(body.kind.back() == kResidualVector);
  for (int i = 0; i < body.num_modes(); ++i) {
    CHECK(body.damping_ratio(i) == (body.kind_of(i) == kFreeVector ? 0.02 : 0.5));
  }
  const auto num_free = static_cast<std::size_t>(std::count(body.kind.begin(), body.kind.end(), kFreeVector));
  std::string list = "0.01";
  for (std::size_t i = 1; i < num_free; ++i) list += ", 0.03";
  const std::string message =
      message_of<InputError>([&] { ratios("[modes]\ndamping_ratio = [" + list + "]\n"); });
  CHECK_THAT(message, Contains("give 'residual_damping_ratio' beside it"));
  CHECK(ratios("[modes]\nresidual_damping_ratio = 0.1\ndamping_ratio = [" + list + "]\n")(0) == 0.01);
}

}  // namespace
}  // namespace sprung::reduce

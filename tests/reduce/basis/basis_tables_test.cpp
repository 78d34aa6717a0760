#include <fmt/format.h>

#include <algorithm>

#include "reduce/design/design.h"
#include "reduce/reduction/reduction.h"
#include "tests/catch.h"
#include "tests/reduce/coupled_vehicle.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

// One line of a table of reduce/README.md.
struct Line {
  std::string name;
  Reduction reduction;
  int num_clamped = 0;  // of the basis kClamped
};

std::vector<Line> list_lines(double highest_hz, const std::vector<InterfaceFreedom>& interface,
                             const std::vector<double>& tolerances) {
  std::vector<Line> lines;
  for (const int n : {4, 8, 16, 32}) {
    lines.push_back(
        {"clamped", {.basis = BasisKind::kClamped, .highest_hz = highest_hz, .interface = interface}, n});
  }
  for (const double tolerance : tolerances) {
    lines.push_back({fmt::format("free, tolerance {:g}", tolerance),
                     {.basis = BasisKind::kFree,
                      .highest_hz = highest_hz,
                      .tolerance = tolerance,
                      .interface = interface}});
  }
  lines.push_back({"fixed interface",
                   {.basis = BasisKind::kFixedInterface, .highest_hz = highest_hz, .interface = interface}});
  return lines;
}

Superelement reduce_by(Design design, const Line& line) {
  design.reduction = line.reduction;
  design.modes = {.wanted = ModeCount{line.num_clamped}};
  return make_superelement(design);
}

std::string format_percent(double share) {
  return share >= kUnbounded ? "none" : fmt::format("{:.2g}", 100.0 * share);
}

double largest_at_rest(const Certificate& certificate) {
  double largest = 0.0;
  for (const InterfaceError& one : certificate.interface) largest = std::max(largest, one.static_error);
  return largest;
}

void check_line(const std::string& line) {
  static const std::string kReadme = testing::read_bytes(testing::source_path("reduce/README.md"));
  INFO(line);
  CHECK(kReadme.find("\n" + line + "\n") != std::string::npos);
}

TEST_CASE("the table of the truck's chassis is what its bases give") {
  const Design design = read_design(testing::source_path("meshes/truck/chassis_certified.toml"));
  for (const Line& line : list_lines(60.0, design.reduction.interface, {0.1, 0.01, 0.001})) {
    const Superelement body = reduce_by(design, line);
    const Certificate& certificate = *body.certificate;
    double frequency = 0.0;
    for (Eigen::Index i = 0; i < certificate.free_hz.size() && certificate.free_hz(i) < 60.0; ++i) {
      frequency = std::max(frequency, certificate.free_error(i));
    }
    check_line(fmt::format("| {} | {} | {} | {} | {} |", line.name, body.num_modes(),
                           format_percent(frequency), format_percent(largest_at_rest(certificate)),
                           format_percent(certificate.largest_error())));
  }
}

TEST_CASE("the table of the ladder frame with stiff joints is what its bases give") {
  const testing::LadderFrame ladder = testing::make_ladder_frame();
  const testing::CoupledVehicle truth = testing::make_ladder_vehicle(ladder);
  const Design design = testing::make_design(ladder.model, ladder.reference, {});
  for (const Line& line : list_lines(70.0, ladder.interface, {0.1, 0.01, 0.0001})) {
    const Superelement body = reduce_by(design, line);
    const testing::VehicleError error =
        testing::compare_vehicles(testing::make_ladder_vehicle(ladder, body), truth, 70.0);
    check_line(fmt::format("| {} | {} | {} | {} | {} | {} |", line.name, body.num_modes(),
                           format_percent(error.frequency), format_percent(error.reaction),
                           format_percent(largest_at_rest(*body.certificate)),
                           format_percent(body.certificate->largest_error())));
  }
}

}  // namespace
}  // namespace sprung::reduce

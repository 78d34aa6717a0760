#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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
  if (share >= kUnbounded) return "no bound";
  return share >= 0.995 ? fmt::format("{:.0f}", 100.0 * share) : fmt::format("{:.2g}", 100.0 * share);
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

// Halves of a beam of 4 m, each with its reference at its middle. Expected: the full model of the whole beam.
TEST_CASE("the table of two half beams that are welded is what their bases give") {
  fem::BeamModel half = testing::make_model(), whole = testing::make_model();
  testing::add_line(half, {0.0, 0.0}, {2.0, 0.0}, 16);
  testing::add_line(whole, {0.0, 0.0}, {4.0, 0.0}, 32);
  const Eigen::VectorXd expected = testing::FreeBodyTruth(whole).calc_frequencies();
  const auto check_half = [&](const std::string& name, BasisKind basis, int num_clamped, double band) {
    Eigen::Index n = 0;
    const auto reduce_half = [&](double weld_at) {
      fem::BeamModel model = half;
      const auto interface = testing::make_interface(model, {testing::find_node_at(model, {weld_at, 0.0})});
      const Superelement body = reduce_by(
          testing::make_design(model, {1.0, 0.0}, {}),
          {name,
           {.basis = basis, .highest_hz = band * expected(2), .tolerance = 1e-3, .interface = interface},
           num_clamped});
      n = body.num_modes();
      return testing::make_reduced_body(body, interface);
    };
    const testing::CoupledBody first = reduce_half(2.0), second = reduce_half(0.0);
    const Eigen::VectorXd found = testing::calc_frequencies(testing::weld(first, second));
    std::string line = fmt::format("| {} | {} |", name, n);
    for (Eigen::Index i = 0; i < 3; ++i)
      line += fmt::format(" {} |", format_percent(std::abs(found(i) / expected(i) - 1.0)));
    check_line(line);
  };
  for (const int n : {4, 8, 16, 32}) check_half("clamped", BasisKind::kClamped, n, 1.05);
  check_half("free, tolerance 0.001", BasisKind::kFree, 0, 1.05);
  for (const double band : {1.05, 8.4})
    check_half(fmt::format("fixed interface, band {:g} f₃", band), BasisKind::kFixedInterface, 0, band);
}

TEST_CASE(
    "with all residual vectors the deflections at rest under interface loads are those of the full model") {
  double largest = 0.0;
  const testing::LadderFrame ladder = testing::make_ladder_frame();
  Design chassis = read_design(testing::source_path("meshes/truck/chassis_certified.toml"));
  Design frame = testing::make_design(ladder.model, ladder.reference, {});
  frame.reduction = {.basis = BasisKind::kFree, .highest_hz = 70.0, .interface = ladder.interface};
  for (Design* design : {&chassis, &frame}) {
    design->reduction.all_residual = true;
    const Eigen::MatrixXd expected =
        testing::FreeBodyTruth(design->model).calc_flexibility_at_rest(design->reduction.interface);
    const Eigen::MatrixXd error = testing::calc_flexibility(make_superelement(*design), 0.0) - expected;
    const Eigen::VectorXd scale = expected.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    REQUIRE(error.allFinite());
    largest = std::max(largest, (scale.asDiagonal() * error * scale.asDiagonal()).cwiseAbs().maxCoeff());
  }

  CHECK(largest < 1e-9);
  check_line(
      "| deflections at rest, all residual vectors: largest error, share of the flexibility | < 1e-9 |");
}

// The true error is the largest at 60 frequencies of the band, and that of the freedom with the largest
// bound.
TEST_CASE("the largest bound over the true error of the random frames is that of the README") {
  double largest = 0.0;
  int num_frames = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Design design = testing::make_random_design(seed, 0.01);
    const Superelement body = make_superelement(design);
    const Certificate& certificate = *body.certificate;
    const InterfaceError& worst = certificate.interface[static_cast<std::size_t>(certificate.find_worst())];
    if (certificate.cutoff_hz < 1.7 * certificate.highest_hz || worst.error < 1e-6) continue;
    const testing::FreeBodyTruth truth(design.model);
    double error = 0.0;
    for (int step = 1; step <= 60; ++step) {
      const double s = std::pow(2.0 * std::numbers::pi * certificate.highest_hz * step / 60.0, 2);
      if (testing::is_resonance(truth, s)) continue;
      const Eigen::VectorXd missed = truth.calc_flexibility(s, design.reduction.interface).real().diagonal() -
                                     testing::calc_flexibility(body, s).diagonal();
      error = std::max(error, missed(certificate.find_worst()) / worst.static_flexibility);
    }
    ++num_frames;
    largest = std::max(largest, worst.error / error);
  }
  check_line(
      fmt::format("| bound over the true error, {} random frames whose first mode left out lies at 1.7 times "
                  "the end of the band or above: largest | {:.2f} |",
                  num_frames, largest));
}

}  // namespace
}  // namespace sprung::reduce

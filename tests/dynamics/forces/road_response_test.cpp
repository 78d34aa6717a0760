// The response of tyres to low waves of the road, against differences of their full laws on such roads.
#include "dynamics/forces/road_response.h"

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "dynamics/forces/distributed_tyre.h"
#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/forces/spring_damper.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::MarkerState;
using dynamics::RoadWave;
using std::numbers::pi;

namespace {

constexpr double kRadius = 0.5, kHeight = 0.46, kPlace = 3.7, kSpeed = 6.0;

// Height a cos(κ (s − place) + phase).
class WavyRoad final : public dynamics::Road {
 public:
  WavyRoad(double amplitude, double wavenumber, double phase)
      : amplitude_(amplitude), wavenumber_(wavenumber), phase_(phase) {}
  std::string_view shape() const override { return "wave"; }
  dynamics::ElementDescription describe() const override { return {}; }
  int num_segments() const override { return 1; }
  double segment_end(int /*k*/) const override { return std::numeric_limits<double>::infinity(); }
  dynamics::RoadSample sample(int /*segment*/, double s) const override {
    const double angle = wavenumber_ * (s - kPlace) + phase_;
    return {amplitude_ * std::cos(angle), -amplitude_ * wavenumber_ * std::sin(angle)};
  }
  double integral(int /*segment*/, double s) const override {
    return amplitude_ / wavenumber_ * std::sin(wavenumber_ * (s - kPlace) + phase_);
  }
  double resolution(int /*segment*/, double /*s*/) const override { return 0.1 * 2.0 * pi / wavenumber_; }

 private:
  double amplitude_, wavenumber_, phase_;
};

using MakeTyre = std::unique_ptr<dynamics::ForceElement> (*)(const dynamics::PlacedRoad& road);
const dynamics::PiecewisePolynomial kSpring({0.0, 2e5, 4e6});

std::unique_ptr<dynamics::ForceElement> make_point_contact(const dynamics::PlacedRoad& road) {
  return std::make_unique<dynamics::PointContactTyre>(
      "tyre",
      dynamics::PointContactTyre::Parameters{
          .marker = 0, .radius = kRadius, .multiplicity = 2.0, .spring = kSpring, .damping = 700.0},
      road);
}
std::unique_ptr<dynamics::ForceElement> make_distributed(const dynamics::PlacedRoad& road) {
  return std::make_unique<dynamics::DistributedTyre>(
      "tyre",
      dynamics::DistributedTyre::Parameters{
          .marker = 0, .radius = kRadius, .multiplicity = 2.0, .spring = kSpring, .damping = 700.0},
      road);
}

// Force x, y and channels of a wheel rolling at kSpeed along ±x, at kPlace of the road.
Eigen::VectorXd act(MakeTyre make, const dynamics::Road& road, double direction) {
  const std::unique_ptr<dynamics::ForceElement> tyre = make({&road, direction, -1.0});
  std::vector<MarkerState> markers(1);
  markers[0].r = {direction * (kPlace - 1.0), kHeight};
  markers[0].v = {direction * kSpeed, 0.0};
  const dynamics::Instant now{0.0, markers};
  std::array<int, 2> branches{};
  tyre->choose_branches(now, branches);
  std::vector<dynamics::Wrench> wrenches(1);
  tyre->add_wrenches(now, branches, wrenches);
  std::vector<double> channels(tyre->channels().size());
  tyre->calc_channels(now, branches, channels);
  Eigen::VectorXd values(2 + static_cast<Eigen::Index>(channels.size()));
  values << wrenches[0].force,
      Eigen::Map<Eigen::VectorXd>(channels.data(), static_cast<Eigen::Index>(channels.size()));
  return values;
}

// h = Re(z e^{iκξ}): z = 1 for the real, z = −i for the imaginary part of the gain.
Eigen::VectorXcd differentiate(MakeTyre make, double wavenumber, double direction) {
  const auto part = [&](double phase) {
    constexpr double kStep = 2e-5;
    const auto at = [&](double amplitude) {
      return act(make, WavyRoad(amplitude, wavenumber, phase), direction);
    };
    return Eigen::VectorXd((8.0 * (at(kStep) - at(-kStep)) - (at(2.0 * kStep) - at(-2.0 * kStep))) /
                           (12.0 * kStep));
  };
  return part(0.0) + std::complex<double>(0.0, 1.0) * part(-0.5 * pi);
}

Eigen::VectorXcd calc_gain(MakeTyre make, double wavenumber, double direction) {
  const dynamics::FlatRoad road;
  const std::unique_ptr<dynamics::ForceElement> tyre = make({&road, direction, -1.0});
  std::vector<MarkerState> markers(1);
  markers[0].r = {direction * (kPlace - 1.0), kHeight};  // at rest
  const dynamics::Instant now{0.0, markers};
  std::array<int, 2> branches{};
  tyre->choose_branches(now, branches);
  const auto place = tyre->find_road_place(now, branches);
  REQUIRE(place);
  CHECK(place->is_pressed);
  CHECK(place->distance == Approx(kPlace));
  std::vector<dynamics::WrenchGain> wrenches(1);
  Eigen::VectorXcd channels(static_cast<Eigen::Index>(tyre->channels().size()));
  tyre->add_road_response(now, branches, RoadWave{.wavenumber = wavenumber, .frequency = wavenumber * kSpeed},
                          wrenches, {channels.data(), static_cast<std::size_t>(channels.size())});
  CHECK(wrenches[0].torque == 0.0);
  Eigen::VectorXcd values(2 + channels.size());
  values << wrenches[0].force, channels;
  return values;
}

}  // namespace

TEST_CASE("Tyres' response to low waves of the road is the slope of their laws", "[forces]") {
  for (const MakeTyre make : {&make_point_contact, &make_distributed}) {
    for (const double direction : {1.0, -1.0}) {
      for (const double length : {8.0, 1.0, 0.31}) {
        CAPTURE(make == &make_distributed, direction, length);
        const double wavenumber = 2.0 * pi / length;
        const Eigen::VectorXcd gain = calc_gain(make, wavenumber, direction);
        const Eigen::VectorXcd expected = differentiate(make, wavenumber, direction);
        REQUIRE(gain.size() == expected.size());
        for (Eigen::Index i = 0; i < gain.size(); ++i) {
          CAPTURE(i, gain[i], expected[i]);
          CHECK(std::abs(gain[i] - expected[i]) <
                1e-5 * std::max(1.0, gain.head(2).cwiseAbs().maxCoeff() * (i < 3)));
        }
      }
    }
  }
}

TEST_CASE("Long waves have the same effect with both kinds of contact", "[forces]") {
  const double wavenumber = 2.0 * pi / 2000.0;
  const Eigen::VectorXcd point = calc_gain(&make_point_contact, wavenumber, 1.0);
  const Eigen::VectorXcd distributed = calc_gain(&make_distributed, wavenumber, 1.0);
  CHECK(std::abs(distributed[1] / point[1] - 1.0) < 1e-6);
  // Standing on a slope the distributed contact leans backwards by it: F₀ h′.
  const double standing = 2.0 * kSpring.value(kRadius - kHeight);
  CHECK(std::abs(distributed[0] / std::complex<double>(0.0, -standing * wavenumber) - 1.0) < 1e-6);
}

TEST_CASE("A wheel in the air is not on the road, and a spring has no position on it", "[forces]") {
  const dynamics::FlatRoad road;
  std::vector<MarkerState> markers(2);
  markers[0].r = {2.0, kRadius + 0.01};
  const dynamics::Instant now{0.0, markers};
  for (const MakeTyre make : {&make_point_contact, &make_distributed}) {
    const std::unique_ptr<dynamics::ForceElement> tyre = make({&road, 1.0, 0.0});
    std::array<int, 2> branches{};
    tyre->choose_branches(now, branches);
    CHECK_FALSE(tyre->find_road_place(now, branches)->is_pressed);
  }
  const dynamics::SpringDamper spring(
      "spring", {.marker_a = 0, .marker_b = 1, .free_length = 1.0, .spring = {}, .damper = {}});
  const std::array<int, 2> branches{};
  CHECK_FALSE(spring.find_road_place(now, branches));
}

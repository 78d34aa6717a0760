// Modes chosen from the forcing, on beams held to the ground: which are kept and which left out.
#include "dynamics/mode_choice/basis_choice.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "dynamics/forces/applied_force.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/mode_choice/held_response.h"
#include "dynamics/mode_choice/neglect_measure.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::BasisChoice;
using dynamics::CandidateMode;
using dynamics::LinearVehicle;
using dynamics::Model;
using dynamics::TimeFunction;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

constexpr int kNumModes = 6;
constexpr dynamics::JudgedQuantities kAll{.points = true, .moments = true, .forces = true, .reactions = true};

// A straight beam, its frame fixed to the ground, 1 m to each side where it has two. Clamped there, it has no
// coordinates but its modes.
struct HeldBeam {
  test::BeamSuperelement beam;
  Model model;
  int tip = 0;

  explicit HeldBeam(const std::vector<double>& nodes, double gravity = 0.0)
      : beam(test::make_beam_superelement(test::make_straight_beam("beam", nodes, 8e6, 300.0, 6.0),
                                          kNumModes)) {
    model.gravity = {0.0, -gravity};
    test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, {1, 2, 3, 4, 5, 6}));
    const int frame = test::add_marker(model, 0, {0.0, 0.0}, "frame");
    const int ground = test::add_marker(model, dynamics::kGround, {0.0, 0.0});
    model.joints.push_back(std::make_unique<dynamics::CoordinateJoint>(
        "clamp", ground, frame, support::SourceLocation{"test.toml", 1, 1}, dynamics::make_fixed_joint(0.0)));
    tip = test::add_node_marker(model, 0, beam.superelement, static_cast<int>(nodes.size()) - 1);
    model.markers.back().name = "beam.tip";
  }
  double frequency(int mode) const { return beam.superelement.frequency_hz[mode - 1]; }

  // A force across the beam, in time.
  void push(int marker, const TimeFunction& force) {
    model.forces.push_back(std::make_unique<dynamics::AppliedForce>(
        "push", dynamics::AppliedForce::Parameters{.marker = marker,
                                                   .axes = dynamics::AppliedForce::Axes::kWorld,
                                                   .force_x = TimeFunction(0.0),
                                                   .force_y = force,
                                                   .torque = TimeFunction(0.0)}));
  }
  void shake(int marker, double frequency_hz) {
    push(marker,
         TimeFunction::harmonic({.mean = 0.0, .amplitude = 5.0, .frequency_hz = frequency_hz, .phase = 0.0}));
  }

  BasisChoice choose(double tolerance, double duration = 2.0) {
    dynamics::number_model(model);
    const LinearVehicle vehicle(model, VectorXd::Zero(model.num_coordinates));
    std::vector<CandidateMode> candidates;
    for (int k = 0; k < kNumModes; ++k) {
      candidates.push_back({"beam", k + 1, frequency(k + 1), beam.superelement.cluster[k], 3 + k});
    }
    return dynamics::choose_basis(vehicle, candidates, {.points = {tip}, .moments = {}}, kAll,
                                  {.road = nullptr, .speed = 0.0, .duration = duration}, tolerance);
  }
};

std::vector<int> kept(const BasisChoice& choice) {
  std::vector<int> numbers;
  for (const auto& verdict : choice.verdicts) {
    if (verdict.is_kept) numbers.push_back(verdict.mode.number);
  }
  return numbers;
}

bool contains(const std::vector<int>& numbers, int number) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

const std::vector<double> kOneSided{0.0, 0.2, 0.4, 0.55, 0.7, 0.85, 1.0};
const std::vector<double> kTwoSided{-1.0, -0.7, -0.4, 0.0, 0.4, 0.7, 1.0};

// A point between two nodes where a mode stands still: its motion across, a share of each node's.
int add_point_at_rest(HeldBeam& beam, int mode) {
  for (std::size_t node = 1; node + 1 < kOneSided.size(); ++node) {
    const auto shape = [&](std::size_t at) {
      return beam.beam.superelement.shapes(3 * static_cast<Eigen::Index>(at) + 1, mode - 1);
    };
    if (shape(node) * shape(node + 1) >= 0.0) continue;
    const double share = shape(node) / (shape(node) - shape(node + 1));
    const int first = test::add_node_marker(beam.model, 0, beam.beam.superelement, static_cast<int>(node));
    const int next = test::add_node_marker(beam.model, 0, beam.beam.superelement, static_cast<int>(node) + 1);
    const auto& there = beam.model.markers[static_cast<std::size_t>(next)];
    auto& marker = beam.model.markers[static_cast<std::size_t>(first)];
    marker.p_BP = (1.0 - share) * marker.p_BP + share * there.p_BP;
    marker.Phi = (1.0 - share) * marker.Phi + share * there.Phi;
    REQUIRE(std::abs(marker.Phi(1, mode - 1)) < 1e-12);
    return first;
  }
  FAIL("the mode has no node");
  return -1;
}

}  // namespace

TEST_CASE("A mode with a node at the load is left out, its excited neighbours are kept", "[choice]") {
  HeldBeam beam(kOneSided);
  const double second = beam.frequency(2);
  // Shaken at the second mode's own frequency, where it would resonate; it moves the tip, which is asked for.
  beam.shake(add_point_at_rest(beam, 2), second);
  const BasisChoice choice = beam.choose(1e-3);
  CHECK_FALSE(contains(kept(choice), 2));
  CHECK(contains(kept(choice), 1));
  CHECK(contains(kept(choice), 3));
  CHECK(choice.verdicts[1].worth.acceleration.rms < 1e-9);
  CHECK(choice.neglected < 1e-3);
  CHECK_THAT(choice.verdicts[1].reason, Contains("left out: "));
  CHECK_THAT(choice.verdicts[0].reason, Contains("kept: ") && Contains(" % of the "));
  // The same load at the tip excites it before all others.
  HeldBeam other(kOneSided);
  other.shake(other.tip, second);
  CHECK(contains(kept(other.choose(1e-3)), 2));
}

TEST_CASE("The higher the frequencies of the load, the more modes are kept", "[choice]") {
  std::size_t last = 0;
  HeldBeam slow(kOneSided), middle(kOneSided), fast(kOneSided);
  for (HeldBeam* beam : {&slow, &middle, &fast}) {
    const int highest = beam == &slow ? 1 : beam == &middle ? 3 : 5;
    beam->push(
        beam->tip,
        TimeFunction::smooth_step(
            {.before = 0.0, .after = 50.0, .start = 0.1, .end = 0.1 + 2.0 / beam->frequency(highest)}));
    const std::size_t number = beam->choose(0.01).num_kept();
    CHECK(number > last);
    last = number;
  }
  CHECK(last < kNumModes);  // one is axial: a load across does not excite it
}

TEST_CASE("At tolerance 0 all modes are kept, those without any share too", "[choice]") {
  HeldBeam beam(kOneSided);
  beam.shake(add_point_at_rest(beam, 2), 3.0);
  const BasisChoice choice = beam.choose(0.0);
  CHECK(choice.num_kept() == kNumModes);
  CHECK(choice.neglected == 0.0);
  CHECK(choice.neglected_of.empty());
}

TEST_CASE("Modes of one frequency stay together, for any rotation of their basis", "[choice]") {
  // Two equal cantilevers, back to back: pairs. Only the right one is pushed.
  const auto choose = [](double turn) {
    HeldBeam beam(kTwoSided);
    auto& body = beam.model.bodies[0];
    Eigen::MatrixXd shapes = beam.beam.superelement.shapes;
    const auto& cluster = beam.beam.superelement.cluster;
    Eigen::MatrixXd R = Eigen::MatrixXd::Identity(kNumModes, kNumModes);
    for (int k = 0; k + 1 < kNumModes; k += 2) {
      REQUIRE(cluster[k] == cluster[k + 1]);
      // First to where the first member is that of the right half alone, then by the turn.
      const Eigen::Index tip = shapes.rows() - 3;
      const Eigen::Vector2d at_tip = shapes.block<3, 2>(tip, k).colwise().sum().transpose();
      const double angle = std::atan2(at_tip[1], at_tip[0]) + turn;
      R.block<2, 2>(k, k) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    }
    body.P *= R;
    body.c *= R;
    body.d *= R;
    body.M_ff = R.transpose() * body.M_ff * R;
    body.M_tt = R.transpose() * body.M_tt * R;
    body.B = R.transpose() * body.B * R;
    for (auto& marker : beam.model.markers) {
      if (marker.body == dynamics::kGround) continue;
      marker.Phi *= R;
    }
    beam.shake(beam.tip, 0.9 * beam.frequency(1));
    return beam.choose(0.05);
  };
  const BasisChoice straight = choose(0.0), turned = choose(0.6);
  // One member is excited, the other not at all; both are kept.
  CHECK(straight.verdicts[0].worth.displacement.rms > 0.5);
  CHECK(straight.verdicts[1].worth.displacement.rms < 1e-6);
  CHECK(straight.verdicts[0].is_kept);
  CHECK(straight.verdicts[1].is_kept);
  CHECK(straight.num_kept() < kNumModes);
  CHECK_THAT(straight.verdicts[1].reason, Contains("modes 1 to 2 of one frequency together"));
  CHECK(kept(turned) == kept(straight));
  CHECK(turned.verdicts[1].worth.displacement.rms > 1e-3);
  for (std::size_t k = 0; k < kNumModes; ++k) {
    CHECK(turned.verdicts[k].reason == straight.verdicts[k].reason);
  }
}

TEST_CASE("Without other forcing, modes that bend under the weight are kept", "[choice]") {
  HeldBeam beam(kOneSided, 9.81);
  dynamics::number_model(beam.model);
  VectorXd q = VectorXd::Zero(beam.model.num_coordinates);
  // η = P^T g / ω² of the clamped modes.
  for (int k = 0; k < kNumModes; ++k) {
    q[3 + k] = -9.81 * beam.model.bodies[0].P(1, k) / std::pow(2.0 * pi * beam.frequency(k + 1), 2);
  }
  const LinearVehicle vehicle(beam.model, q);
  std::vector<CandidateMode> candidates;
  for (int k = 0; k < kNumModes; ++k) candidates.push_back({"beam", k + 1, beam.frequency(k + 1), k, 3 + k});
  const BasisChoice choice =
      dynamics::choose_basis(vehicle, candidates, {.points = {beam.tip}, .moments = {}}, kAll,
                             {.road = nullptr, .speed = 0.0, .duration = 1.0}, 0.05);
  // The tip's sag by mode 1 alone, of the whole: φ₁ η₁ / Σ φ η.
  const Eigen::RowVectorXd tip = beam.model.markers[static_cast<std::size_t>(beam.tip)].Phi.row(1);
  const double whole = tip.dot(q.tail(kNumModes));
  CHECK(choice.verdicts[0].worth.weight == Approx(tip[0] * q[3] / whole).epsilon(1e-3));
  CHECK(kept(choice) == std::vector<int>{1});
  CHECK_THAT(choice.verdicts[0].reason, Contains("of the static "));
}

TEST_CASE("Modes above the lines of a very long run are kept", "[choice]") {
  // Shaken above the third mode for so long that the lines end below.
  HeldBeam beam(kOneSided);
  beam.shake(beam.tip, beam.frequency(3));
  const BasisChoice choice = beam.choose(0.01, 40000.0 / beam.frequency(3));
  REQUIRE(choice.remarks.size() == 1);
  CHECK_THAT(choice.remarks[0],
             Contains("are left out of the prediction: ") && Contains(", so that all modes above "));
  for (int k = 2; k < kNumModes; ++k) {
    CHECK(choice.verdicts[static_cast<std::size_t>(k)].is_kept);
    CHECK(choice.verdicts[static_cast<std::size_t>(k)].reason ==
          "kept: above the frequencies of the prediction");
  }
}

TEST_CASE("Modes measured in thinned lines have the shares of all lines", "[choice]") {
  HeldBeam beam(kOneSided);
  beam.push(beam.tip,
            TimeFunction::smooth_step(
                {.before = 0.0, .after = 50.0, .start = 0.1, .end = 0.1 + 2.0 / beam.frequency(5)}));
  dynamics::number_model(beam.model);
  const LinearVehicle vehicle(beam.model, VectorXd::Zero(beam.model.num_coordinates));
  const dynamics::WatchedQuantities watched =
      dynamics::make_watched_quantities(vehicle, {.points = {beam.tip}, .moments = {}}, kAll);
  const dynamics::NeglectMeasure measure(vehicle, watched, {3, 4, 5, 6, 7, 8},
                                         {.road = nullptr, .speed = 0.0, .duration = 2.0}, 0.01);
  const std::vector<std::vector<int>> sets{{0}, {1}, {2}, {4}, {2, 1}, {0, 3, 4}};
  const std::vector<dynamics::NeglectedShares> alone = measure.measure_alone(sets);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const dynamics::NeglectedShares exact = measure.measure(sets[k]);
    for (Eigen::Index i = 0; i < exact.rms.size(); ++i) {
      CHECK(alone[k].rms[i] == Approx(exact.rms[i]).epsilon(0.05).margin(1e-4));
      if (alone[k].peak[i] == 0.0) continue;  // not looked at
      CHECK(alone[k].peak[i] == Approx(exact.peak[i]).epsilon(0.1).margin(1e-4));
    }
    CHECK((alone[k].peak.array() > 0.0).count() == 3);
    CHECK(alone[k].weight == exact.weight);
  }
}

TEST_CASE("Holding modes has the effect of leaving them out of the equations", "[choice]") {
  // Not fixed to the ground but on springs, where the modes are coupled through the frame's motion.
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 5);
  Model model;
  const int body =
      test::add_body(model, dynamics::make_flexible_body("frame", frame.superelement, {1, 2, 3, 4, 5}));
  const int tip =
      test::add_node_marker(model, body, frame.superelement, reduce::find_point(frame.superelement, "tip"));
  const int foot =
      test::add_node_marker(model, body, frame.superelement, reduce::find_point(frame.superelement, "foot"));
  for (const auto& [name, marker, x, y] :
       {std::tuple{"a", tip, 1.3, -1.1}, {"b", foot, -0.6, -0.2}, {"c", tip, 2.3, 0.4}}) {
    test::add_spring(model, name, marker, test::add_marker(model, dynamics::kGround, {x, y}), 1.0, 7e3, 90.0);
  }
  dynamics::number_model(model);
  const LinearVehicle vehicle(model, VectorXd::Zero(model.num_coordinates));
  const std::vector<int> coordinates{3, 4, 5, 6, 7};
  const dynamics::LinearOutputs outputs = dynamics::make_point_outputs(vehicle, tip);
  const dynamics::HeldResponseSolver solver(vehicle, outputs, coordinates);
  const std::complex<double> s(0.0, 2.0 * pi * 7.0);
  const Eigen::VectorXcd force =
      VectorXd::LinSpaced(model.num_coordinates, -1.0, 2.0).cast<std::complex<double>>();
  const Eigen::VectorXcd channels = Eigen::VectorXcd::Zero(vehicle.channel_rows().back());
  const dynamics::HeldResponse response = solver.solve(s.imag(), force, channels);

  const std::vector<int> order{3, 0, 4, 1, 2};
  const dynamics::LinearisedSystem& system = vehicle.system();
  const Eigen::MatrixXcd Z = system.stiffness + s * system.damping + s * s * system.mass;
  for (std::size_t count = 1; count <= order.size(); ++count) {
    const std::vector<int> held(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
    std::vector<Eigen::Index> free;  // without joints all coordinates are independent
    for (Eigen::Index i = 0; i < Z.rows(); ++i) {
      const int coordinate = system.partition.independent[static_cast<std::size_t>(i)];
      if (std::find(held.begin(), held.end(), coordinate - 3) == held.end()) free.push_back(i);
    }
    Eigen::VectorXcd x = Eigen::VectorXcd::Zero(Z.rows());
    const Eigen::VectorXcd right = system.directions.transpose() * force;
    const Eigen::Map<const Eigen::VectorX<Eigen::Index>> places(free.data(),
                                                                static_cast<Eigen::Index>(free.size()));
    const Eigen::MatrixXcd Z_free = Z(places, places);
    const Eigen::VectorXcd right_free = right(places), x_free = Z_free.partialPivLu().solve(right_free);
    x(places) = x_free;
    const Eigen::VectorXcd change =
        dynamics::sum_outputs(outputs, s.imag(), x, force, channels) - response.outputs;
    CHECK(change.norm() > 1e-3 * response.outputs.norm());
    CHECK((dynamics::calc_change(response, held) - change).norm() < 1e-10 * change.norm());
  }
}

TEST_CASE("A wrong tolerance is the caller's mistake", "[choice]") {
  HeldBeam beam(kOneSided);
  CHECK_THROWS_WITH(beam.choose(1.0), Contains("choose_basis: tolerance must be from 0 to below 1, got 1"));
}

#include "dynamics/preparation/static_lengths.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "dynamics/functions/find_zero.h"
#include "dynamics/input/make_model.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/preparation/massless_check.h"
#include "dynamics/preparation/turned_springs.h"
#include "dynamics/system/system_terms.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMostIterations = 50;
constexpr double kTolerance = 1e-9;        // relative to the static length
constexpr double kRounding = 1e-7;         // the same, of balances with stiff tyres
constexpr int kIterationsToRounding = 20;  // after them only rounding is left
constexpr double kSmallestShare = 0.2;     // of a free length that one step leaves of it
constexpr double kNearlyReached = 0.01;    // relative error of lengths
constexpr double kHeld = 1e-3;             // of a length, by which the whole weight compresses a held spring
constexpr double kMostCompressed = 4.0;    // of a length: the largest deflection that is looked for
constexpr double kRedrawn = 0.5;  // |log| of a length over that of the drawing, which is hardly meant

// A linear spring in the place of an air spring, about as stiff as one that carries a vehicle.
SpringDamper::Parameters make_stand_in(const AirSpring::Parameters& air) {
  constexpr double kUsualPressure = 6e5;  // absolute [Pa]
  const double area = air.effective_area.value(air.design_height);
  const double stiffness = air.exponent * kUsualPressure * area * area / air.volume;
  return {.free_length = air.design_height,
          .multiplicity = air.multiplicity,
          .spring = PiecewisePolynomial({0.0, stiffness}),
          .damper = {}};
}

// A linear spring that nearly keeps a length, in the place of any spring.
SpringDamper::Parameters make_held(double length, double weight) {
  return {
      .free_length = length, .spring = PiecewisePolynomial({0.0, weight / (kHeld * length)}), .damper = {}};
}

// Deflection nearest to 0 at which a spring of that length carries a load; 0 where none is found.
double find_deflection(const PiecewisePolynomial& spring, double load, double length) {
  const auto excess = [&](double deflection) { return spring.value(deflection) - load; };
  const double at_free = excess(0.0);
  for (double share = kTolerance; share <= 1.0; share *= 2.0) {
    for (const double end : {share * kMostCompressed * length, -share * (1.0 - kSmallestShare) * length}) {
      const double at_end = excess(end);
      if (at_end * at_free <= 0.0)
        return find_zero(excess, {0.0, at_free, end, at_end}, {.width = kTolerance * length});
    }
  }
  return 0.0;
}

// The springs whose static length is given, and their lengths in a position of the vehicle.
class StaticSprings {
 public:
  // Puts the stand-ins into the vehicle; `place_back` takes them out again.
  explicit StaticSprings(Vehicle& vehicle) {
    for (std::size_t f = 0; f < vehicle.forces.size(); ++f) {
      ForceParameters& parameters = vehicle.forces[f].parameters;
      if (!vehicle.forces[f].static_length) continue;
      forces_.push_back(f);
      air_springs_.emplace_back();
      if (auto* air = std::get_if<AirSpring::Parameters>(&parameters)) {
        air_springs_.back() = *air;
        parameters = make_stand_in(*air);
      }
    }
  }
  bool empty() const { return forces_.empty(); }
  Eigen::Index size() const { return static_cast<Eigen::Index>(forces_.size()); }
  std::size_t force(Eigen::Index i) const { return forces_[static_cast<std::size_t>(i)]; }
  double& free_length(Vehicle& vehicle, Eigen::Index i) const {
    ForceParameters& parameters = vehicle.forces[force(i)].parameters;
    if (auto* leaf = std::get_if<LeafSpring::Parameters>(&parameters)) return leaf->free_length;
    return std::get<SpringDamper::Parameters>(parameters).free_length;
  }

  // Free lengths at which the springs carry their loads in the balance of the vehicle whose springs are held
  // at the targets, or the targets where it has none. A vehicle whose springs carry nothing as drawn may fall
  // through them.
  // @param[in,out] q  as drawn; in that balance
  Eigen::VectorXd find_loaded(Vehicle& vehicle, const std::function<Model(const Vehicle&)>& make_balance,
                              const Eigen::VectorXd& targets, Eigen::VectorXd& q) const {
    double weight = 0.0;
    for (const Body& body : make_balance(vehicle).bodies) weight += body.mass * vehicle.gravity.norm();
    if (!(weight > 0.0)) return targets;
    std::vector<ForceParameters> kept;
    for (Eigen::Index i = 0; i < size(); ++i)
      kept.push_back(std::exchange(vehicle.forces[force(i)].parameters, make_held(targets[i], weight)));
    const Model held = make_balance(vehicle);
    for (Eigen::Index i = 0; i < size(); ++i)
      vehicle.forces[force(i)].parameters = std::move(kept[static_cast<std::size_t>(i)]);
    // The held springs have no internal states; those of other elements begin at zero, as in the drawing.
    Eigen::VectorXd q_held = Eigen::VectorXd::Zero(held.num_coordinates);
    const int num_mechanical = held.first_state();
    q_held.head(num_mechanical) = q.head(num_mechanical);
    try {
      q_held = find_equilibrium(held, q_held).q;
    } catch (const support::NumericalError&) {
      return targets;
    }
    q.head(num_mechanical) = q_held.head(num_mechanical);
    const Eigen::VectorXd lengths = calc_lengths(held, q_held);
    Eigen::VectorXd free_lengths = targets;
    for (Eigen::Index i = 0; i < size(); ++i) {
      const double load = make_held(targets[i], weight).spring.value(targets[i] - lengths[i]);
      const auto deflection_of = [&](const auto& law) {
        return find_deflection(law.spring, load / law.multiplicity, targets[i]);
      };
      const ForceParameters& parameters = vehicle.forces[force(i)].parameters;
      const auto* leaf = std::get_if<LeafSpring::Parameters>(&parameters);
      free_lengths[i] +=
          leaf ? deflection_of(*leaf) : deflection_of(std::get<SpringDamper::Parameters>(parameters));
    }
    return free_lengths;
  }

  // The result of spring i, which is written into the vehicle.
  StaticLengthResult place_back(Vehicle& vehicle, Eigen::Index i, double length) const {
    ForceDescription& force = vehicle.forces[this->force(i)];
    StaticLengthResult result{.force = force.name, .length = length, .free_length = free_length(vehicle, i)};
    std::optional<AirSpring::Parameters> air = air_springs_[static_cast<std::size_t>(i)];
    if (!air) return result;
    const auto& spring = std::get<SpringDamper::Parameters>(force.parameters);
    const double load = spring.spring.value(spring.free_length - length);
    if (!(load > 0.0)) {
      throw support::InputError(
          force.static_length->location,
          fmt::format("'forces.{}.{}': the air spring would have to pull with {:.6g} N in static equilibrium",
                      force.name, force.static_length->key, -load));
    }
    result.free_length.reset();
    result.gauge_pressure = load / air->effective_area.value(length);
    air->pressure = air->ambient_pressure + *result.gauge_pressure;
    force.parameters = std::move(*air);
    return result;
  }

  Eigen::VectorXd calc_lengths(const Model& model, const Eigen::VectorXd& q) const {
    SystemTerms terms(model);
    terms.update_positions(0.0, q);
    Eigen::VectorXd lengths(size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      const std::vector<int> markers = model.forces[force(i)]->markers();
      lengths[i] = (terms.markers()[static_cast<std::size_t>(markers[1])].r -
                    terms.markers()[static_cast<std::size_t>(markers[0])].r)
                       .norm();
    }
    return lengths;
  }

 private:
  std::vector<std::size_t> forces_;
  std::vector<std::optional<AirSpring::Parameters>> air_springs_;  // for each of these
};

// The lengths wanted: those of the file, else those of the vehicle as drawn.
Eigen::VectorXd find_targets(const Vehicle& vehicle, const StaticSprings& springs,
                             const Eigen::VectorXd& drawn) {
  Eigen::VectorXd targets = drawn;
  for (Eigen::Index i = 0; i < springs.size(); ++i) {
    const StaticLength& wanted = *vehicle.forces[springs.force(i)].static_length;
    if (wanted.length) targets[i] = *wanted.length;
  }
  return targets;
}

// The iterate whose lengths are closest to the targets. There the springs that can reach theirs have nearly
// done so.
struct ClosestLengths {
  Eigen::VectorXd lengths;
  double error = std::numeric_limits<double>::infinity();  // norm of the relative errors

  void update(const Eigen::VectorXd& found, const Eigen::VectorXd& targets) {
    const double found_error = ((found - targets).array() / targets.array()).matrix().norm();
    if (!(found_error < error)) return;
    lengths = found;
    error = found_error;
  }
};

[[noreturn]] void throw_not_reached(const Vehicle& vehicle, const StaticSprings& springs,
                                    const Eigen::VectorXd& targets, const Eigen::VectorXd& lengths,
                                    const std::string& where) {
  Eigen::Index worst = 0;
  ((lengths - targets).array() / targets.array()).abs().maxCoeff(&worst);
  const ForceDescription& force = vehicle.forces[springs.force(worst)];
  throw support::InputError(
      force.static_length->location,
      fmt::format(
          "'forces.{}.{}': a length of {:.6g} m cannot be reached together with the other static "
          "lengths: {} it comes to {:.6g} m, {:.2g} m off; check that the spring carries load, and that its "
          "stops are out of reach",
          force.name, force.static_length->key, targets[worst], where, lengths[worst],
          std::abs(lengths[worst] - targets[worst])));
}

// The lengths alone would also fit a vehicle that has fallen through its springs. The one to blame is that
// whose length is farthest from the drawing, which may have turned another one; as drawn, the one that has
// turned.
void check_directions(const Vehicle& vehicle, const Model& model, const StaticSprings& springs,
                      const Eigen::VectorXd& drawn, const Eigen::VectorXd& found) {
  std::vector<std::size_t> turned = find_turned_springs(vehicle, model, drawn, found);
  std::erase_if(turned, [&](std::size_t f) { return !vehicle.forces[f].static_length; });
  if (turned.empty()) return;
  const Eigen::ArrayXd change =
      (springs.calc_lengths(model, found).array() / springs.calc_lengths(model, drawn).array()).log().abs();
  Eigen::Index farthest = 0;
  const bool is_redrawn = change.maxCoeff(&farthest) > kRedrawn;
  const ForceDescription& force = vehicle.forces[is_redrawn ? springs.force(farthest) : turned.front()];
  const bool has_turned =
      std::any_of(turned.begin(), turned.end(), [&](std::size_t f) { return &vehicle.forces[f] == &force; });
  throw support::InputError(
      force.static_length->location,
      fmt::format(
          "'forces.{}.{}': where the length is reached, {} the other way than as drawn; check that it "
          "carries its load{}",
          force.name, force.static_length->key,
          has_turned ? "the spring points" : "'" + vehicle.forces[turned.front()].name + "' points",
          has_turned ? "" : ", and that the length is right"));
}

}  // namespace

std::vector<StaticLengthResult> solve_static_lengths(
    Vehicle& vehicle, const std::function<Model(const Vehicle&)>& make_balance) {
  const StaticSprings springs(vehicle);
  if (springs.empty()) return {};
  Model model = make_balance(vehicle);
  Eigen::VectorXd q = make_start_positions(model, vehicle);
  assemble_positions(model, q);
  check_massless_bodies(vehicle, model, q);
  const Eigen::VectorXd drawn = q;
  const Eigen::VectorXd targets = find_targets(vehicle, springs, springs.calc_lengths(model, q));
  Eigen::VectorXd free_lengths = springs.find_loaded(vehicle, make_balance, targets, q), lengths, error, step;
  ClosestLengths closest;
  Eigen::MatrixXd B = Eigen::MatrixXd::Identity(springs.size(), springs.size());  // of the inverse Jacobian
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    for (Eigen::Index i = 0; i < springs.size(); ++i) springs.free_length(vehicle, i) = free_lengths[i];
    model = make_balance(vehicle);
    try {
      q = find_equilibrium(model, q).q;
    } catch (const support::NumericalError&) {
      if (iteration == 0 || closest.error < kNearlyReached) throw;  // not by the free lengths that were tried
      throw_not_reached(vehicle, springs, targets, closest.lengths,
                        fmt::format("in {} iterations", iteration));
    }
    lengths = springs.calc_lengths(model, q);
    closest.update(lengths, targets);
    const Eigen::VectorXd before = error;
    error = lengths - targets;
    const double tolerance = iteration < kIterationsToRounding ? kTolerance : kRounding;
    if ((error.array().abs() <= tolerance * targets.array()).all()) {
      check_directions(vehicle, model, springs, drawn, q);
      // The run looks for its balance from the drawing: that may be another one.
      q = find_equilibrium(model, drawn).q;
      check_directions(vehicle, model, springs, drawn, q);
      const Eigen::VectorXd from_drawn = springs.calc_lengths(model, q);
      if (((from_drawn - targets).array().abs() > kNearlyReached * targets.array()).any())
        throw_not_reached(vehicle, springs, targets, from_drawn, "in the balance found from the drawing");
      std::vector<StaticLengthResult> results;
      for (Eigen::Index i = 0; i < springs.size(); ++i)
        results.push_back(springs.place_back(vehicle, i, lengths[i]));
      return results;
    }
    if (before.size() > 0) {
      const Eigen::VectorXd By = B * (error - before);
      const double denominator = step.dot(By);
      if (denominator != 0.0) B += (step - By) * (step.transpose() * B) / denominator;
    }
    step = -B * error;
    const double shrink =
        ((1.0 - kSmallestShare) * free_lengths.array() / (-step).array().max(1e-300)).minCoeff();
    step *= std::min(1.0, shrink);
    free_lengths += step;
  }
  throw_not_reached(vehicle, springs, targets, closest.lengths,
                    fmt::format("in {} iterations", kMostIterations));
}

}  // namespace sprung::dynamics

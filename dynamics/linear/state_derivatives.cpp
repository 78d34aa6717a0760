#include "dynamics/linear/state_derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/support/dense/vector_span.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

// Longest step of the differences by velocity, natural sizes per second.
constexpr double kVelocityStep = 1e-3;
// How often they are halved at most. A kink within the shortest reach, 5e-8 of a natural size or 1.6e-5 of it
// per second, is one at rest: that is above what the equilibrium is known to, and above the dead bands of
// branches that change with the sign of a rate.
constexpr int kPositionHalvings = 12, kVelocityHalvings = 6;
// Jump of a channel by its two slopes over this step that counts as rounding, of its size.
constexpr double kSameSlope = 1e-9;

const Model& model_of(const PartitionedEquations& equations) {
  return equations.terms().model();
}

int coordinate_of(const PartitionedEquations& equations, Eigen::Index k) {
  return equations.partition().independent[static_cast<std::size_t>(k)];
}

double scale_of(const PartitionedEquations& equations, Eigen::Index k) {
  return model_of(equations).coordinate_scale(coordinate_of(equations, k));
}

// Sets velocities relative to a steady motion at the present positions.
void set_velocities(PartitionedEquations& equations, const Eigen::VectorXd& rate_independent,
                    const SteadyMotion& motion) {
  const Eigen::VectorXd w = motion.calc_velocity(model_of(equations), equations.q());
  Eigen::VectorXd v_independent = rate_independent;
  for (Eigen::Index k = 0; k < v_independent.size(); ++k) v_independent[k] += w[coordinate_of(equations, k)];
  equations.update_velocities(support::as_span(v_independent));
}

// Sets rest at positions that are shifted along the k-th independent coordinate.
void set_shifted_rest(PartitionedEquations& equations, double time, Eigen::VectorXd q_independent,
                      Eigen::Index k, double distance, const SteadyMotion& motion) {
  q_independent[k] += distance;
  if (equations.update_positions(time, support::as_span(q_independent)) !=
      PartitionedEquations::Outcome::kGood) {
    throw support::NumericalError(
        fmt::format("linearise: the constraints cannot be satisfied at a distance of {} along {}", distance,
                    model_of(equations).coordinate_name(coordinate_of(equations, k))));
  }
  // Joints open by 1e-12 of the length scale would shift a stiffness by 1e-8 of the largest one.
  equations.refine_positions();
  set_velocities(equations, Eigen::VectorXd::Zero(q_independent.size()), motion);
}

// Evaluates the forces, and accelerations where they are needed. @return the branches in use
std::vector<int> evaluate(PartitionedEquations& equations, Needed needed) {
  std::vector<int> branches = equations.terms().find_branches();
  if (needed == Needed::kForces) {
    equations.update_forces(branches);
  } else {
    equations.update_accelerations(branches);
  }
  return branches;
}

// The longest step, by halves, within which the laws on each side of rest are those just beside it.
// @param set  goes to a distance from rest
template <typename Set>
double shorten_step(const PartitionedEquations& equations, double longest, int num_halvings, const Set& set) {
  // From outside to inside: beside a kink at rest its branches stay in use, also within a dead band.
  const auto choose = [&](double distance, std::vector<int> branches) {
    set(distance);
    equations.terms().choose_branches(branches);
    return branches;
  };
  set(longest);
  std::vector<int> ahead = equations.terms().find_branches();
  set(-longest);
  std::vector<int> behind = equations.terms().find_branches();
  const double shortest = std::ldexp(longest, -num_halvings);
  const std::vector<int> just_ahead = choose(shortest, ahead), just_behind = choose(-shortest, behind);
  double step = longest;
  while (step > shortest && !(ahead == just_ahead && behind == just_behind)) {
    step *= 0.5;
    ahead = choose(step, ahead);
    behind = choose(-step, behind);
  }
  return step;
}

void add_kink(const Kink& kink, std::vector<Kink>& kinks) {
  const auto known = std::ranges::find_if(kinks, [&](const Kink& other) {
    return other.element == kink.element && other.in_position == kink.in_position;
  });
  if (known == kinks.end())
    kinks.push_back(kink);
  else
    known->is_at_rest |= kink.is_at_rest;
}

// The channels of a force element at the state evaluated last.
Eigen::VectorXd calc_channels_of(const PartitionedEquations& equations, std::size_t force,
                                 std::span<const int> branches) {
  const Model& model = model_of(equations);
  const ForceElement& element = *model.forces[force];
  Eigen::VectorXd values(static_cast<Eigen::Index>(element.channels().size()));
  element.calc_channels(equations.terms().instant_of(force), model.branches_of(force, branches),
                        {values.data(), element.channels().size()});
  return values;
}

// The channels of all force elements at both signs of a velocity, summed, and how large they are.
struct BothWays {
  std::vector<Eigen::VectorXd> sums, sizes;
};
BothWays sum_both_ways(PartitionedEquations& equations, const Eigen::VectorXd& velocity,
                       const SteadyMotion& motion) {
  BothWays both;
  for (const double sign : {1.0, -1.0}) {
    set_velocities(equations, sign * velocity, motion);
    const std::vector<int> branches = evaluate(equations, Needed::kForces);
    for (std::size_t f = 0; f < model_of(equations).forces.size(); ++f) {
      const Eigen::VectorXd values = calc_channels_of(equations, f, branches);
      if (sign > 0.0) {
        both.sums.push_back(values);
        both.sizes.emplace_back(values.cwiseAbs());
      } else {
        both.sums[f] += values;
        both.sizes[f] += values.cwiseAbs();
      }
    }
  }
  return both;
}

}  // namespace

PositionDerivative differentiate_by_position(PartitionedEquations& equations, double time,
                                             const Eigen::VectorXd& q_independent,
                                             const StateFunction& function, const SteadyMotion& motion,
                                             Needed needed, Eigen::MatrixXd* spread) {
  const Eigen::Index f = q_independent.size();
  PositionDerivative derivative{{}, Eigen::VectorXd::Constant(f, kPositionStep)};
  if (f == 0) return derivative;
  std::vector<int> branches;  // at the point evaluated last
  const auto value_at = [&](Eigen::Index k, double distance) -> Eigen::VectorXd {
    set_shifted_rest(equations, time, q_independent, k, distance, motion);
    branches = evaluate(equations, needed);
    return function(equations, branches);
  };
  const Eigen::VectorXd middle = value_at(0, 0.0);
  const std::vector<int> at_rest = branches;
  derivative.value.resize(middle.size(), f);
  if (spread) spread->resize(middle.size(), f);
  for (Eigen::Index k = 0; k < f; ++k) {
    double h = kPositionStep * scale_of(equations, k);
    Eigen::VectorXd far = value_at(k, 2.0 * h);
    bool holds = branches == at_rest;
    Eigen::VectorXd far_back = value_at(k, -2.0 * h);
    holds &= branches == at_rest;
    if (!holds) {
      h = 0.5 * shorten_step(equations, 2.0 * h, kPositionHalvings, [&](double distance) {
            set_shifted_rest(equations, time, q_independent, k, distance, motion);
          });
      derivative.steps[k] = h / scale_of(equations, k);
      far = value_at(k, 2.0 * h);
      far_back = value_at(k, -2.0 * h);
    }
    const Eigen::VectorXd near = value_at(k, h), near_back = value_at(k, -h);
    const Eigen::VectorXd wide = (far - far_back) / (4.0 * h), narrow = (near - near_back) / (2.0 * h);
    // A kink within the shortest reach has no place in the extrapolation.
    const bool is_shortest = h <= std::ldexp(kPositionStep, -kPositionHalvings) * scale_of(equations, k);
    derivative.value.col(k) = is_shortest ? wide : (4.0 * narrow - wide) / 3.0;
    if (!spread) continue;
    const Eigen::VectorXd narrower = (value_at(k, 0.5 * h) - value_at(k, -0.5 * h)) / h;
    spread->col(k) = (derivative.value.col(k) - (4.0 * narrower - narrow) / 3.0).cwiseAbs() +
                     (far + far_back - 4.0 * (near + near_back) + 6.0 * middle).cwiseAbs() / (2.0 * h);
  }
  return derivative;
}

Eigen::MatrixXd differentiate_by_velocity(PartitionedEquations& equations, const StateFunction& function,
                                          const SteadyMotion& motion, Needed needed) {
  const Eigen::Index f = equations.num_freedoms();
  Eigen::MatrixXd derivative;
  const auto set = [&](Eigen::Index k, double velocity) {
    set_velocities(equations, velocity * Eigen::VectorXd::Unit(f, k), motion);
  };
  const auto value_at = [&](Eigen::Index k, double velocity) {
    set(k, velocity);
    return function(equations, evaluate(equations, needed));
  };
  for (Eigen::Index k = 0; k < f; ++k) {
    const double h = shorten_step(equations, kVelocityStep * scale_of(equations, k), kVelocityHalvings,
                                  [&](double velocity) { set(k, velocity); });
    // A law with |v| v, as of an orifice, gives a difference in proportion to its step: it cancels between
    // two.
    const Eigen::VectorXd wide = (value_at(k, h) - value_at(k, -h)) / (2.0 * h);
    const Eigen::VectorXd narrow = (value_at(k, 0.5 * h) - value_at(k, -0.5 * h)) / h;
    const bool is_shortest = h <= std::ldexp(kVelocityStep, -kVelocityHalvings) * scale_of(equations, k);
    if (k == 0) derivative.resize(wide.size(), f);
    derivative.col(k) = is_shortest ? wide : 2.0 * narrow - wide;
  }
  return derivative;
}

std::string Kink::describe() const {
  if (is_at_rest)
    return fmt::format("'{}' changes its law at static equilibrium: the mean of its two slopes is used",
                       element);
  return fmt::format(
      "'{}' changes its law very close to static equilibrium: its slope there is used, which holds in small "
      "motion alone",
      element);
}

std::vector<Kink> find_kinks(PartitionedEquations& equations, double time,
                             const Eigen::VectorXd& q_independent, const SteadyMotion& motion) {
  const Eigen::Index f = q_independent.size();
  const Model& model = model_of(equations);
  std::vector<Kink> kinks;
  const double farthest = 2.0 * kPositionStep;
  const auto branches_at = [&](Eigen::Index k, double distance) {
    set_shifted_rest(equations, time, q_independent, k, distance, motion);
    return equations.terms().find_branches();
  };
  for (Eigen::Index k = 0; k < f; ++k) {
    for (const double share : {farthest, std::ldexp(farthest, -kPositionHalvings)}) {
      const double distance = share * scale_of(equations, k);
      const std::vector<int> ahead = branches_at(k, distance), behind = branches_at(k, -distance);
      for (std::size_t e = 0; e < model.forces.size(); ++e) {
        if (!std::ranges::equal(model.branches_of(e, ahead), model.branches_of(e, behind)))
          add_kink({model.forces[e]->name, true, share < farthest}, kinks);
      }
    }
  }
  if (f > 0) set_shifted_rest(equations, time, q_independent, 0, 0.0, motion);
  const BothWays rest = sum_both_ways(equations, Eigen::VectorXd::Zero(f), motion);
  for (Eigen::Index k = 0; k < f; ++k) {
    const Eigen::VectorXd velocity = kVelocityStep * scale_of(equations, k) * Eigen::VectorXd::Unit(f, k);
    const BothWays wide = sum_both_ways(equations, velocity, motion),
                   narrow = sum_both_ways(equations, 0.5 * velocity, motion);
    for (std::size_t e = 0; e < model.forces.size(); ++e) {
      // Of a jump of the slope by s the sum is s h more than at rest; a square of the rate cancels.
      const Eigen::ArrayXd jump = 4.0 * (narrow.sums[e] - rest.sums[e]) - (wide.sums[e] - rest.sums[e]);
      if ((jump.abs() > kSameSlope * wide.sizes[e].array()).any())
        add_kink({model.forces[e]->name, false, true}, kinks);
    }
  }
  return kinks;
}

}  // namespace sprung::dynamics

#include "dynamics/linear/state_derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "tools/support/dense/vector_span.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

// Of the differences by velocity, natural sizes per second: far above the dead bands of branches that change
// with the sign of a rate.
constexpr double kVelocityStep = 1e-3;
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

// Evaluates velocities relative to a steady motion, and what depends on them, at the present positions.
// @return the branches in use
std::vector<int> set_velocities(PartitionedEquations& equations, const Eigen::VectorXd& rate_independent,
                                const SteadyMotion& motion, Needed needed) {
  const Eigen::VectorXd w = motion.calc_velocity(model_of(equations), equations.q());
  Eigen::VectorXd v_independent = rate_independent;
  for (Eigen::Index k = 0; k < v_independent.size(); ++k) v_independent[k] += w[coordinate_of(equations, k)];
  equations.update_velocities(support::as_span(v_independent));
  std::vector<int> branches = equations.terms().find_branches();
  if (needed == Needed::kForces) {
    equations.update_forces(branches);
  } else {
    equations.update_accelerations(branches);
  }
  return branches;
}

// Evaluates rest at positions that are shifted along the k-th independent coordinate.
// @return the branches in use
std::vector<int> set_shifted_rest(PartitionedEquations& equations, double time, Eigen::VectorXd q_independent,
                                  Eigen::Index k, double distance, const SteadyMotion& motion,
                                  Needed needed) {
  q_independent[k] += distance;
  if (equations.update_positions(time, support::as_span(q_independent)) !=
      PartitionedEquations::Outcome::kGood) {
    throw support::NumericalError(
        fmt::format("linearise: the constraints cannot be satisfied at a distance of {} along {}", distance,
                    model_of(equations).coordinate_name(coordinate_of(equations, k))));
  }
  // Joints open by 1e-12 of the length scale would shift a stiffness by 1e-8 of the largest one.
  equations.refine_positions();
  return set_velocities(equations, Eigen::VectorXd::Zero(q_independent.size()), motion, needed);
}

void add_kink(const ForceElement& element, bool in_position, std::vector<Kink>& kinks) {
  const bool is_known = std::any_of(kinks.begin(), kinks.end(), [&](const Kink& kink) {
    return kink.element == element.name && kink.in_position == in_position;
  });
  if (!is_known) kinks.push_back({element.name, in_position});
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
    const std::vector<int> branches = set_velocities(equations, sign * velocity, motion, Needed::kForces);
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

Eigen::MatrixXd differentiate_by_position(PartitionedEquations& equations, double time,
                                          const Eigen::VectorXd& q_independent, const StateFunction& function,
                                          const SteadyMotion& motion, Needed needed,
                                          Eigen::MatrixXd* spread) {
  Eigen::MatrixXd derivative;
  const auto value_at = [&](Eigen::Index k, double distance) -> Eigen::VectorXd {
    return function(equations, set_shifted_rest(equations, time, q_independent, k, distance, motion, needed));
  };
  Eigen::VectorXd middle;
  if (spread && q_independent.size() > 0) middle = value_at(0, 0.0);
  for (Eigen::Index k = 0; k < q_independent.size(); ++k) {
    const double h = kPositionStep * scale_of(equations, k);
    const Eigen::VectorXd far = value_at(k, 2.0 * h), far_back = value_at(k, -2.0 * h);
    const Eigen::VectorXd near = value_at(k, h), near_back = value_at(k, -h);
    const Eigen::VectorXd wide = (far - far_back) / (4.0 * h), narrow = (near - near_back) / (2.0 * h);
    if (k == 0) derivative.resize(wide.size(), q_independent.size());
    derivative.col(k) = (4.0 * narrow - wide) / 3.0;
    if (!spread) continue;
    if (k == 0) spread->resize(wide.size(), q_independent.size());
    const Eigen::VectorXd narrower = (value_at(k, 0.5 * h) - value_at(k, -0.5 * h)) / h;
    spread->col(k) = (derivative.col(k) - (4.0 * narrower - narrow) / 3.0).cwiseAbs() +
                     (far + far_back - 4.0 * (near + near_back) + 6.0 * middle).cwiseAbs() / (2.0 * h);
  }
  return derivative;
}

Eigen::MatrixXd differentiate_by_velocity(PartitionedEquations& equations, const StateFunction& function,
                                          const SteadyMotion& motion, Needed needed) {
  const Eigen::Index f = equations.num_freedoms();
  Eigen::MatrixXd derivative;
  const auto value_at = [&](Eigen::Index k, double velocity) {
    return function(equations,
                    set_velocities(equations, velocity * Eigen::VectorXd::Unit(f, k), motion, needed));
  };
  for (Eigen::Index k = 0; k < f; ++k) {
    // A law with |v| v, as of an orifice, gives a difference in proportion to its step: it cancels between
    // two.
    const double h = kVelocityStep * scale_of(equations, k);
    const Eigen::VectorXd wide = (value_at(k, h) - value_at(k, -h)) / (2.0 * h);
    const Eigen::VectorXd narrow = (value_at(k, 0.5 * h) - value_at(k, -0.5 * h)) / h;
    const Eigen::VectorXd slope = 2.0 * narrow - wide;
    if (k == 0) derivative.resize(slope.size(), f);
    derivative.col(k) = slope;
  }
  return derivative;
}

std::string Kink::describe() const {
  return fmt::format("'{}' changes its law at static equilibrium or very close to it: a mean slope is used",
                     element);
}

std::vector<Kink> find_kinks(PartitionedEquations& equations, double time,
                             const Eigen::VectorXd& q_independent, const SteadyMotion& motion) {
  const Eigen::Index f = q_independent.size();
  const Model& model = model_of(equations);
  std::vector<Kink> kinks;
  for (Eigen::Index k = 0; k < f; ++k) {
    const double reach = 2.0 * kPositionStep * scale_of(equations, k);
    const std::vector<int> ahead =
        set_shifted_rest(equations, time, q_independent, k, reach, motion, Needed::kForces);
    const std::vector<int> behind =
        set_shifted_rest(equations, time, q_independent, k, -reach, motion, Needed::kForces);
    for (std::size_t e = 0; e < model.forces.size(); ++e) {
      if (!std::ranges::equal(model.branches_of(e, ahead), model.branches_of(e, behind)))
        add_kink(*model.forces[e], true, kinks);
    }
  }
  if (f > 0) set_shifted_rest(equations, time, q_independent, 0, 0.0, motion, Needed::kForces);
  const BothWays rest = sum_both_ways(equations, Eigen::VectorXd::Zero(f), motion);
  for (Eigen::Index k = 0; k < f; ++k) {
    const Eigen::VectorXd velocity = kVelocityStep * scale_of(equations, k) * Eigen::VectorXd::Unit(f, k);
    const BothWays wide = sum_both_ways(equations, velocity, motion),
                   narrow = sum_both_ways(equations, 0.5 * velocity, motion);
    for (std::size_t e = 0; e < model.forces.size(); ++e) {
      // Of a jump of the slope by s the sum is s h more than at rest; a square of the rate cancels.
      const Eigen::ArrayXd jump = 4.0 * (narrow.sums[e] - rest.sums[e]) - (wide.sums[e] - rest.sums[e]);
      if ((jump.abs() > kSameSlope * wide.sizes[e].array()).any()) add_kink(*model.forces[e], false, kinks);
    }
  }
  return kinks;
}

}  // namespace sprung::dynamics

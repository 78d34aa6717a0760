#include "dynamics/analysis/partitioned_ode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

// The tolerance is meant for a whole run, of which errors of the steps add up; this share of it is allowed in
// a step. With it the energy book closes to the tolerance.
constexpr double kStepShare = 1.0 / 300.0;

}  // namespace

PartitionedOde::PartitionedOde(const Model& model)
    : model_(&model), equations_(model), branches_(static_cast<std::size_t>(model.num_branches)) {
  for (const auto& force : model.forces) num_switches_ += force->num_switches();
  y_.resize(static_cast<std::size_t>(size()));
  evaluated_y_.resize(2 * static_cast<std::size_t>(num_freedoms()));
  // A natural velocity: what gravity gives over a length scale, at least one natural size per second. Neither
  // depends on where the origin is.
  velocity_scale_ = std::max(1.0, std::sqrt(model.gravity.norm() / model.length_scale));
  double mass = 0.0;
  for (const Body& body : model.bodies) mass += body.mass;
  energy_scale_ = 0.5 * mass * std::pow(velocity_scale_ * model.length_scale, 2);
}

void PartitionedOde::set_state(const State& state, double dissipated, double input) {
  equations_.choose_partition_at(state.time, state.q);
  ++coordinate_version_;
  evaluated_time_ = std::numeric_limits<double>::quiet_NaN();
  branches_ = state.branches;
  const std::vector<int>& independent = equations_.partition().independent;
  const std::size_t f = independent.size();
  natural_sizes_.clear();
  for (const int i : independent) natural_sizes_.push_back(model_->coordinate_scale(i));
  for (std::size_t k = 0; k < f; ++k) {
    y_[k] = state.q[independent[k]];
    y_[f + k] = state.v[independent[k]];
  }
  y_[2 * f] = dissipated;
  y_[2 * f + 1] = input;
}

bool PartitionedOde::evaluate_motion(double time, std::span<const double> y) {
  const auto f = static_cast<std::size_t>(equations_.num_freedoms());
  if (time == evaluated_time_ && std::equal(evaluated_y_.begin(), evaluated_y_.end(), y.begin())) return true;
  evaluated_time_ = std::numeric_limits<double>::quiet_NaN();
  if (equations_.update_positions(std::min(time, latest_time_), y.first(f)) !=
      PartitionedEquations::Outcome::kGood)
    return false;
  equations_.update_velocities(y.subspan(f, f));
  evaluated_time_ = time;
  std::copy(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(2 * f), evaluated_y_.begin());
  return true;
}

State PartitionedOde::make_state(double time, std::span<const double> y) {
  if (!evaluate_motion(time, y) ||
      equations_.update_accelerations(branches_) != PartitionedEquations::Outcome::kGood) {
    throw support::NumericalError(fmt::format(
        "the joints cannot be closed at t = {:.9g} s: a singular position; try a smaller step", time));
  }
  return {.time = time, .q = equations_.q(), .v = equations_.v(), .branches = branches_};
}

std::vector<BranchChange> PartitionedOde::update_branches() {
  const std::vector<int> old_branches = branches_;
  equations_.terms().choose_branches(branches_);
  std::vector<BranchChange> changes;
  for (std::size_t i = 0; i < model_->forces.size(); ++i) {
    const ForceElement& force = *model_->forces[i];
    const auto first = static_cast<std::size_t>(model_->force_branches[i]);
    const auto count = static_cast<std::size_t>(force.num_branches());
    const std::string text = force.describe_change(std::span(old_branches).subspan(first, count),
                                                   std::span(branches_).subspan(first, count));
    if (!text.empty()) changes.push_back({force.name, text});
  }
  return changes;
}

// Differences of the accelerations at the branches that hold: M δq̈ = −C δv − K δq.
bool PartitionedOde::calc_small_motion(double time, std::span<const double> y, SmallMotion& motion) {
  constexpr double kShift = 1e-6;  // of the natural size
  const Eigen::Index f = num_freedoms();
  std::vector<double> moved(y.begin(), y.end()), y_dot(y.size());
  if (!calc_derivative(time, moved, y_dot)) return false;
  motion.mass = equations_.calc_reduced_mass(equations_.calc_directions());
  const Eigen::VectorXd base = Eigen::Map<const Eigen::VectorXd>(y_dot.data() + f, f);
  Eigen::MatrixXd gradient(f, 2 * f);
  for (Eigen::Index k = 0; k < 2 * f; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double shift = kShift * natural_sizes_[static_cast<std::size_t>(k % f)];
    moved[i] = y[i] + shift;
    const bool good = calc_derivative(time, moved, y_dot);
    moved[i] = y[i];
    if (!good) return false;
    gradient.col(k) = (Eigen::Map<const Eigen::VectorXd>(y_dot.data() + f, f) - base) / shift;
  }
  motion.stiffness = -motion.mass * gradient.leftCols(f);
  motion.damping = -motion.mass * gradient.rightCols(f);
  return true;
}

double PartitionedOde::calc_longest_step() const {
  double longest = std::numeric_limits<double>::infinity();
  for (const auto& force : model_->forces) {
    longest = std::min(longest, force->calc_longest_step(equations_.terms().instant()));
  }
  if (model_->has_motions) {
    for (const auto& joint : model_->joints) {
      longest = std::min(longest,
                         joint->calc_longest_step(equations_.terms().instant().time, model_->length_scale));
    }
  }
  return std::min(longest, model_->time_resolution);
}

double PartitionedOde::update_next_break(double time) {
  const auto next = std::upper_bound(model_->time_breaks.begin(), model_->time_breaks.end(), time);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (next == model_->time_breaks.end()) return latest_time_ = kInfinity;
  latest_time_ = std::nextafter(*next, -kInfinity);
  return *next;
}

bool PartitionedOde::calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) {
  ++num_derivatives_;
  if (!evaluate_motion(time, y)) return false;
  if (equations_.update_accelerations(branches_) != PartitionedEquations::Outcome::kGood) return false;
  const std::vector<int>& independent = equations_.partition().independent;
  const std::size_t f = independent.size();
  for (std::size_t k = 0; k < f; ++k) {
    y_dot[k] = y[f + k];
    y_dot[f + k] = equations_.v_dot()[independent[k]];
  }
  y_dot[2 * f] = equations_.terms().power().dissipated;
  y_dot[2 * f + 1] = equations_.terms().power().input;
  y_dot[2 * f + 1] += equations_.calc_motion_power();
  return true;
}

bool PartitionedOde::calc_switches(double time, std::span<const double> y, std::span<double> values) {
  if (!evaluate_motion(time, y)) return false;
  std::size_t next = 0;
  for (std::size_t i = 0; i < model_->forces.size(); ++i) {
    const ForceElement& force = *model_->forces[i];
    const auto count = static_cast<std::size_t>(force.num_switches());
    force.calc_switches(equations_.terms().instant(),
                        std::span(branches_).subspan(static_cast<std::size_t>(model_->force_branches[i]),
                                                     static_cast<std::size_t>(force.num_branches())),
                        values.subspan(next, count));
    next += count;
  }
  return true;
}

void PartitionedOde::calc_error_scales(std::span<const double> y, std::span<double> scales) const {
  const std::size_t f = natural_sizes_.size();
  for (std::size_t k = 0; k < f; ++k) {
    const double natural = natural_sizes_[k];
    scales[k] = kStepShare * natural;
    scales[f + k] = kStepShare * (velocity_scale_ * natural + std::abs(y[f + k]));
  }
  scales[2 * f] = scales[2 * f + 1] = kStepShare * energy_scale_;
}

}  // namespace sprung::dynamics

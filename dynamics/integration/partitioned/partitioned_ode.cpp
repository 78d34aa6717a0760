#include "dynamics/integration/partitioned/partitioned_ode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/integration/throw_stopped.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

PartitionedOde::PartitionedOde(const Model& model)
    : model_(&model), equations_(model), piece_(model), scales_(model) {
  y_.resize(static_cast<std::size_t>(size()));
  directions_.resize(model.num_coordinates, num_freedoms());
}

void PartitionedOde::set_state(const State& state, double dissipated, double input) {
  equations_.choose_partition_at(state.time, state.q);
  ++coordinate_version_;
  equations_.accept_motion(state.time, state.q, state.v);
  equations_.set_fading_forces(state.fading);
  piece_.set_branches(state.branches);
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
  const std::span<const double> q_i = y.first(f), v_i = y.subspan(f, f);
  const double formula_time = piece_.evaluation_time(time);
  return equations_.is_at(formula_time, q_i, v_i) ||
         equations_.update_motion(formula_time, q_i, v_i) == PartitionedEquations::Outcome::kGood;
}

void PartitionedOde::throw_not_finite(double time) const {
  const SystemTerms& terms = equations_.terms();
  std::vector<Wrench> wrenches(model_->markers.size());
  const std::span<const int> branches = piece_.branches();
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    const Power power = force.add_wrenches(terms.instant_of(f), model_->branches_of(f, branches), wrenches);
    const bool is_finite = std::isfinite(power.dissipated) && std::isfinite(power.input) &&
                           std::all_of(wrenches.begin(), wrenches.end(), [](const Wrench& wrench) {
                             return wrench.force.allFinite() && std::isfinite(wrench.torque);
                           });
    if (is_finite) continue;
    throw support::NumericalError(
        fmt::format("'forces.{}' is not a finite number at t = {:.9g} s: look at its functions and sizes",
                    force.name, time));
  }
  throw_open_joints(time);
}

void PartitionedOde::close_joints(double time, std::span<const double> y) {
  // A second search starts at the accepted motion, to which the first has gone back.
  if (!evaluate_motion(time, y) && !evaluate_motion(time, y)) throw_open_joints(time);
}

void PartitionedOde::calc_accelerations(double time, std::span<const double> y) {
  close_joints(time, y);
  if (equations_.update_accelerations(piece_.branches()) != PartitionedEquations::Outcome::kGood)
    throw_not_finite(time);
}

State PartitionedOde::make_state(double time, std::span<const double> y) {
  calc_accelerations(time, y);
  return {.time = time,
          .q = equations_.q(),
          .v = equations_.v(),
          .branches = piece_.branches(),
          .fading = equations_.terms().fading_forces()};
}

void PartitionedOde::continue_small_motion(const KnownMotion& known) {
  const Eigen::Index f = num_freedoms();
  const std::vector<int>& indices = known.independent;
  const auto is_square = [f](const Eigen::MatrixXd& matrix) {
    return matrix.rows() == f && matrix.cols() == f;
  };
  const bool fits = static_cast<Eigen::Index>(indices.size()) == f && is_square(known.motion.mass) &&
                    is_square(known.motion.damping) && is_square(known.motion.stiffness) &&
                    std::all_of(indices.begin(), indices.end(),
                                [&](int i) { return i >= 0 && i < model_->num_coordinates; });
  if (!fits) return;
  known_ = known;
  if (indices == equations_.partition().independent) return;
  const Eigen::MatrixXd T = equations_.calc_directions()(indices, Eigen::all);
  known_->independent = equations_.partition().independent;
  for (Eigen::MatrixXd* matrix : {&known_->motion.mass, &known_->motion.damping, &known_->motion.stiffness})
    *matrix = T.transpose() * *matrix * T;
}

// The motion that was set; without one, by differences of the accelerations at the branches that hold:
// M δq̈ = −C δv − K δq. The stiffness of the bodies' modes is added without a difference: those of stiff modes
// turn with the bodies, and the part of second order in the shift would exceed the stiffness of soft ones.
// Where only velocities are shifted, dependent modal coordinates move by the error to which joints are
// closed.
bool PartitionedOde::calc_small_motion(double time, std::span<const double> y, SmallMotion& motion) {
  if (known_ && known_->independent == equations_.partition().independent) {
    motion = std::move(known_->motion);
    known_.reset();
    hold_states(motion);
    return true;
  }
  constexpr double kShift = 1e-6;  // of the natural size
  const Eigen::Index f = num_freedoms();
  const std::vector<int>& independent = equations_.partition().independent;
  std::vector<double> moved(y.begin(), y.end()), y_dot(y.size());
  if (!calc_derivative(time, moved, y_dot)) return false;
  equations_.calc_directions(directions_);
  const Eigen::VectorXd q = equations_.q();
  motion.mass = equations_.calc_reduced_mass(directions_);
  const Eigen::VectorXd base = Eigen::Map<const Eigen::VectorXd>(y_dot.data() + f, f);
  Eigen::MatrixXd gradient(f, 2 * f);
  Eigen::VectorXd response;
  for (Eigen::Index k = 0; k < 2 * f; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double shift = kShift * natural_sizes_[static_cast<std::size_t>(k % f)];
    moved[i] = y[i] + shift;
    const bool good = calc_derivative(time, moved, y_dot);
    moved[i] = y[i];
    if (!good) return false;
    equations_.calc_response(apply_modal_stiffness(*model_, equations_.q() - q), response);
    gradient.col(k) =
        (Eigen::Map<const Eigen::VectorXd>(y_dot.data() + f, f) - base + response(independent)) / shift;
  }
  motion.stiffness = directions_.transpose() * apply_modal_stiffness(*model_, directions_) -
                     motion.mass * gradient.leftCols(f);
  motion.damping = -motion.mass * gradient.rightCols(f);
  hold_states(motion);
  return true;
}

std::vector<int> PartitionedOde::elastic_freedoms() const {
  const std::vector<int>& independent = equations_.partition().independent;
  std::vector<int> elastic;
  for (std::size_t k = 0; k < independent.size(); ++k) {
    const bool is_mechanical = independent[k] < model_->first_state();
    if (is_mechanical && model_->body_coordinate(independent[k]).local >= 3)
      elastic.push_back(static_cast<int>(k));
  }
  return elastic;
}

bool PartitionedOde::calc_mass_columns(double time, std::span<const double> y,
                                       const std::vector<int>& freedoms, Eigen::MatrixXd& columns) {
  if (!evaluate_motion(time, y)) return false;
  equations_.update_mass();
  equations_.calc_mass_columns(freedoms, columns);
  return true;
}

// Gives the coordinates of internal states a little stiffness, so that they count as vibration and not as
// free motion: the pairs then know their coupling by damping. Nothing depends on these coordinates.
void PartitionedOde::hold_states(SmallMotion& motion) const {
  constexpr double kStiffness = 1.0;  // 1/s²
  for (Eigen::Index k = model_->num_mechanical_freedoms(); k < num_freedoms(); ++k) {
    motion.stiffness.row(k).setZero();
    motion.stiffness.col(k).setZero();
    motion.stiffness(k, k) = kStiffness;
  }
}

bool PartitionedOde::calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) {
  ++num_derivatives_;
  if (!evaluate_motion(time, y)) return false;
  if (equations_.update_accelerations(piece_.branches()) != PartitionedEquations::Outcome::kGood)
    return false;
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
  piece_.calc_switches(equations_.terms(), values);
  return true;
}

void PartitionedOde::calc_error_scales(std::span<const double> y, std::span<double> scales) const {
  const std::vector<int>& independent = equations_.partition().independent;
  const std::size_t f = independent.size();
  for (std::size_t k = 0; k < f; ++k) {
    scales[k] = scales_.position(independent[k]);
    scales[f + k] = scales_.velocity(independent[k], y[f + k]);
  }
  scales[2 * f] = scales[2 * f + 1] = scales_.energy();
}

void PartitionedOde::limit_to_accelerations(std::span<const double> y, std::span<double> scales) const {
  const std::vector<int>& independent = equations_.partition().independent;
  const std::size_t f = independent.size();
  for (std::size_t k = 0; k < f; ++k) {
    scales[k] = scales_.position_in_vibration(independent[k]);
    scales[f + k] = scales_.velocity_in_vibration(independent[k], y[f + k]);
  }
}

}  // namespace sprung::dynamics

#include "dynamics/system/partitioned_equations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

constexpr double kAssemblyTolerance = 1e-12;  // of the model's length scale
// Smallest pivot of φ_q, of its largest, below which joints are closed better: an error of closing is divided
// by it in positions, and twice in velocities.
constexpr double kSmallPivot = 1e-2;
constexpr double kAim = 0.01;  // of the tolerance: a larger residual would be noise to a fine integration
// Of the length scale, (kAim kAssemblyTolerance)^(3/5): after a step d the first residual r is of order d³
// and falls by the share d = r^(1/3), so that r d² is left after two iterations.
constexpr double kLargeFirst = 4e-9;
constexpr int kMaxNewtonIterations = 12;
constexpr int kIterationsToRounding = 3;  // after them only the rounding of coordinates is left

}  // namespace

PartitionedEquations::PartitionedEquations(const Model& model)
    : model_(&model),
      full_(model, SystemTerms::Markers::kActing),
      num_freedoms_(model.num_freedoms()),
      num_constraints_(model.num_constraints) {
  accepted_q_ = accepted_v_ = trial_q_ = trial_v_ = Eigen::VectorXd::Zero(model.num_coordinates);
  direction_ = momentum_ = trial_q_;
  residual_ = correction_ = column_ = dependent_column_ = Eigen::VectorXd::Zero(num_constraints_);
  step_.resize(static_cast<std::size_t>(num_freedoms_));
}

void PartitionedEquations::choose_partition_at(double time, const Eigen::VectorXd& q) {
  if (q.size() != model_->num_coordinates) {
    throw std::invalid_argument(fmt::format("PartitionedEquations: {} positions for {} coordinates", q.size(),
                                            model_->num_coordinates));
  }
  accept_motion(time, q, Eigen::VectorXd::Zero(model_->num_coordinates));
  mutable_terms().update_positions(time, q);
  mutable_terms().update_jacobian();
  mutable_terms().update_mass();
  partition_ = choose_partition(terms());
  dependents_ = DependentSolver(terms().jacobian(), partition_, model_->num_coordinates);
  dependents_.factorise(terms().jacobian());
  dependents_.set_reference();
  const double share = std::min(1.0, partition_.smallest_pivot / kSmallPivot);
  closing_tolerance_ = share * share * kAssemblyTolerance * model_->length_scale;
  dependent_angles_.clear();
  for (const Body& body : model_->bodies) {
    const int angle = body.first_coordinate + 2;
    const std::vector<int>& dependent = partition_.dependent;
    if (std::binary_search(dependent.begin(), dependent.end(), angle)) dependent_angles_.push_back(angle);
  }
}

void PartitionedEquations::accept_motion(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  accepted_time_ = time;
  accepted_q_ = q;
  accepted_v_ = v;
}

void PartitionedEquations::accept_motion() {
  if (terms().has(SystemTerms::Term::kVelocities)) accept_motion(terms().time(), q(), v());
}

void PartitionedEquations::return_to_accepted() {
  mutable_terms().update_positions(accepted_time_, accepted_q_);
  refactor();
}

bool PartitionedEquations::has_lost_turns() const {
  const double half = 0.5 * (terms().time() - accepted_time_);
  return std::any_of(dependent_angles_.begin(), dependent_angles_.end(), [&](int i) {
    return std::abs(q()[i] - accepted_q_[i] - half * (accepted_v_[i] + v()[i])) > std::numbers::pi;
  });
}

bool PartitionedEquations::is_at(double time, std::span<const double> q_independent,
                                 std::span<const double> v_independent) const {
  if (terms().time() != time || !terms().has(SystemTerms::Term::kVelocities)) return false;
  for (std::size_t k = 0; k < partition_.independent.size(); ++k) {
    const int i = partition_.independent[k];
    if (q()[i] != q_independent[k] || v()[i] != v_independent[k]) return false;
  }
  return true;
}

void PartitionedEquations::refactor() {
  mutable_terms().update_jacobian();
  dependents_.factorise(terms().jacobian());
}

// Newton's iteration for the dependent coordinates. The factors of φ_d are those of the last positions: new
// ones cost about as much as an iteration, and are computed where more than two would be needed without them.
bool PartitionedEquations::solve_dependents(double time) {
  const double tolerance = closing_tolerance_;
  double last = 0.0;
  for (int iteration = 0; iteration < kMaxNewtonIterations; ++iteration) {
    mutable_terms().place_joints(time, trial_q_);
    if (num_constraints_ == 0) return true;
    terms().calc_residual(residual_);
    const double size = residual_.lpNorm<Eigen::Infinity>();
    if (!residual_.allFinite()) return false;  // the norm may pass over a NaN
    if (size <= tolerance) return true;
    if (iteration >= kIterationsToRounding && size <= model_->calc_rounding(trial_q_)) return true;
    const bool is_slow = iteration == 0 ? size > kLargeFirst * model_->length_scale
                                        : size * (size / last) * (size / last) > kAim * tolerance;
    if (is_slow) refactor();
    last = size;
    dependents_.solve(residual_, correction_);
    for (std::size_t k = 0; k < partition_.dependent.size(); ++k) {
      trial_q_[partition_.dependent[k]] -= correction_[static_cast<Eigen::Index>(k)];
    }
  }
  return false;
}

PartitionedEquations::Outcome PartitionedEquations::update_positions(double time,
                                                                     std::span<const double> q_independent) {
  // The prediction: the dependents follow the independents by the last factors, and by the last accelerations
  // where those are known; with both it is right to second order in time. Then Newton closes the joints.
  const double since = time - terms().time();
  const double weight = full_.has_accelerations() ? 0.5 * since * since : 0.0;
  // Accelerations that do not count may be NaN.
  const auto drift = [&](int i) { return weight > 0.0 ? weight * v_dot()[i] : 0.0; };
  for (std::size_t k = 0; k < partition_.independent.size(); ++k) {
    const int i = partition_.independent[k];
    if (!std::isfinite(q_independent[k])) {
      return_to_accepted();
      return Outcome::kNotFinite;
    }
    step_[k] = q_independent[k] - q()[i] - drift(i);
    trial_q_[i] = q_independent[k];
  }
  if (num_constraints_ > 0) {
    residual_.setZero();
    dependents_.add_independent_product(step_, residual_);
    dependents_.solve(residual_, correction_);
    for (std::size_t k = 0; k < partition_.dependent.size(); ++k) {
      const int i = partition_.dependent[k];
      trial_q_[i] = q()[i] + (drift(i) - correction_[static_cast<Eigen::Index>(k)]);
    }
  }
  if (solve_dependents(time)) {
    mutable_terms().place_others();
    refactor();
    if (!dependents_.is_mirrored()) return Outcome::kGood;
  }
  return_to_accepted();
  return Outcome::kNotAssembled;
}

void PartitionedEquations::refine_positions() {
  if (num_constraints_ == 0) return;
  trial_q_ = q();
  terms().calc_residual(residual_);
  dependents_.solve(residual_, correction_);
  for (std::size_t k = 0; k < partition_.dependent.size(); ++k) {
    trial_q_[partition_.dependent[k]] -= correction_[static_cast<Eigen::Index>(k)];
  }
  mutable_terms().place_joints(terms().time(), trial_q_);
  mutable_terms().place_others();
  refactor();
}

void PartitionedEquations::update_velocities(std::span<const double> v_independent) {
  for (std::size_t k = 0; k < partition_.independent.size(); ++k)
    trial_v_[partition_.independent[k]] = v_independent[k];
  if (num_constraints_ > 0) {
    terms().calc_time_rate(residual_);
    dependents_.add_independent_product(v_independent, residual_);
    dependents_.solve(residual_, correction_);
    for (std::size_t k = 0; k < partition_.dependent.size(); ++k) {
      trial_v_[partition_.dependent[k]] = -correction_[static_cast<Eigen::Index>(k)];
    }
  }
  mutable_terms().update_velocities(trial_v_);
}

PartitionedEquations::Outcome PartitionedEquations::update_motion(double time,
                                                                  std::span<const double> q_independent,
                                                                  std::span<const double> v_independent) {
  const Outcome outcome = update_positions(time, q_independent);
  if (outcome != Outcome::kGood) return outcome;
  update_velocities(v_independent);
  if (!has_lost_turns()) return Outcome::kGood;
  return_to_accepted();
  return Outcome::kNotAssembled;
}

void PartitionedEquations::update_forces(std::span<const int> branches) {
  mutable_terms().update_mass();
  mutable_terms().update_forces(branches);
}

PartitionedEquations::Outcome PartitionedEquations::update_accelerations(std::span<const int> branches) {
  return full_.update_accelerations(branches) ? Outcome::kGood : Outcome::kNotFinite;
}

Eigen::MatrixXd PartitionedEquations::calc_directions() const {
  Eigen::MatrixXd directions;
  calc_directions(directions);
  return directions;
}

void PartitionedEquations::calc_directions(Eigen::MatrixXd& directions) const {
  directions.resize(model_->num_coordinates, num_freedoms_);
  for (std::size_t k = 0; k < partition_.independent.size(); ++k)
    calc_direction(k, directions.col(static_cast<Eigen::Index>(k)));
}

// A column of D.
void PartitionedEquations::calc_direction(std::size_t freedom, Eigen::Ref<Eigen::VectorXd> direction) const {
  direction.setZero();
  direction[partition_.independent[freedom]] = 1.0;
  dependents_.get_independent_column(freedom, column_);
  dependents_.solve(column_, dependent_column_);
  for (std::size_t d = 0; d < partition_.dependent.size(); ++d)
    direction[partition_.dependent[d]] = -dependent_column_[static_cast<Eigen::Index>(d)];
}

Eigen::MatrixXd PartitionedEquations::calc_reduced_mass(const Eigen::MatrixXd& directions) const {
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(num_freedoms_, num_freedoms_);
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    const Eigen::MatrixXd rows = directions.middleRows(body.first_coordinate, body.num_coordinates());
    reduced += rows.transpose() * terms().mass(b) * rows;
  }
  const auto states = directions.bottomRows(model_->num_states());
  if (states.rows() > 0) reduced += states.transpose() * states;
  return reduced;
}

void PartitionedEquations::calc_mass_columns(const std::vector<int>& freedoms,
                                             Eigen::MatrixXd& columns) const {
  columns.resize(num_freedoms_, static_cast<Eigen::Index>(freedoms.size()));
  for (std::size_t k = 0; k < freedoms.size(); ++k) {
    calc_direction(static_cast<std::size_t>(freedoms[k]), direction_);
    apply_mass(direction_, momentum_);
    reduce(momentum_, columns.col(static_cast<Eigen::Index>(k)).data());
  }
}

void PartitionedEquations::apply_mass(const Eigen::VectorXd& x, Eigen::VectorXd& product) const {
  product = x;
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    auto of_body = product.segment(body.first_coordinate, body.num_coordinates());
    of_body.setZero();
    for (int i = 0; i < body.num_coordinates(); ++i) {
      const double value = x[body.first_coordinate + i];
      if (value != 0.0) of_body += value * terms().mass(b).col(i);  // few coordinates of a direction move
    }
  }
}

Eigen::VectorXd PartitionedEquations::apply_mass(const Eigen::VectorXd& x) const {
  Eigen::VectorXd product;
  apply_mass(x, product);
  return product;
}

// Dᵀ x = x_i − φ_iᵀ φ_d⁻ᵀ x_d.
void PartitionedEquations::reduce(const Eigen::VectorXd& x, double* reduced) const {
  for (std::size_t i = 0; i < partition_.independent.size(); ++i) reduced[i] = x[partition_.independent[i]];
  for (std::size_t d = 0; d < partition_.dependent.size(); ++d)
    column_[static_cast<Eigen::Index>(d)] = x[partition_.dependent[d]];
  dependents_.solve_transposed(column_, dependent_column_);
  dependents_.subtract_transposed_product(dependent_column_, {reduced, partition_.independent.size()});
}

Eigen::VectorXd PartitionedEquations::calc_reduced(const Eigen::VectorXd& x) const {
  Eigen::VectorXd reduced(num_freedoms_);
  reduce(x, reduced.data());
  return reduced;
}

Eigen::MatrixXd PartitionedEquations::find_pattern_of_directions() const {
  Eigen::MatrixXd pattern = Eigen::MatrixXd::Zero(model_->num_coordinates, num_freedoms_);
  for (std::size_t k = 0; k < partition_.independent.size(); ++k)
    pattern(partition_.independent[k], static_cast<Eigen::Index>(k)) = 1.0;
  pattern(partition_.dependent, Eigen::all) = dependents_.find_followers(num_freedoms_);
  return pattern;
}

// D x_i = x_i and −φ_d⁻¹ φ_i x_i.
Eigen::VectorXd PartitionedEquations::calc_free_motion(const Eigen::VectorXd& x_independent) const {
  Eigen::VectorXd motion(model_->num_coordinates);
  for (std::size_t i = 0; i < partition_.independent.size(); ++i)
    motion[partition_.independent[i]] = x_independent[static_cast<Eigen::Index>(i)];
  column_.setZero();
  dependents_.add_independent_product({x_independent.data(), partition_.independent.size()}, column_);
  dependents_.solve(column_, dependent_column_);
  for (std::size_t d = 0; d < partition_.dependent.size(); ++d)
    motion[partition_.dependent[d]] = -dependent_column_[static_cast<Eigen::Index>(d)];
  return motion;
}

}  // namespace sprung::dynamics

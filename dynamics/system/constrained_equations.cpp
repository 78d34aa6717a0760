#include "dynamics/system/constrained_equations.h"

#include <cmath>
#include <limits>

namespace sprung::dynamics {

namespace {

constexpr double kClosed = 1e-12;  // of the model's length scale
constexpr int kMaxClosings = 12;
constexpr int kClosingsToRounding = 3;  // after them only the rounding of coordinates is left
constexpr double kExact = 1e-13;        // change of accelerations that ends their improvement, of their size
constexpr int kMaxImprovements = 100;

}  // namespace

ConstrainedEquations::ConstrainedEquations(const Model& model, SystemTerms::Markers scope)
    : model_(&model), terms_(model, scope), multipliers_(terms_.jacobian(), model.num_constraints) {
  v_dot_ = correction_ = closing_q_ = closing_v_ = Eigen::VectorXd::Zero(model.num_coordinates);
  lambda_ = motion_rate_ = violation_ = impulse_ = Eigen::VectorXd::Zero(model.num_constraints);
  momentum_ = change_ = v_dot_;
  inverse_mass_ = Eigen::VectorXd::Ones(model.num_coordinates);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (terms_.masses()[b].is_constant())
      terms_.masses()[b].solve(inverse_mass_.data() + model.bodies[b].first_coordinate);
    else
      varying_bodies_.push_back(b);
  }
}

void ConstrainedEquations::apply_inverse_mass(Eigen::VectorXd& x) const {
  x.array() *= inverse_mass_.array();
  for (const std::size_t b : varying_bodies_) {
    terms_.masses()[b].solve(x.data() + model_->bodies[b].first_coordinate);
  }
}

bool ConstrainedEquations::factorise() {
  return multipliers_.factorise(terms_.jacobian(), terms_.masses());
}

// impulse_ = (φ_q M⁻¹ φ_qᵀ)⁻¹ violation_, correction_ = M⁻¹φ_qᵀ impulse_: the smallest change in the mass
// metric that takes the violation away.
void ConstrainedEquations::calc_correction() {
  multipliers_.solve(violation_, impulse_);
  correction_.setZero();
  terms_.jacobian().add_transposed_product(impulse_, correction_);
  apply_inverse_mass(correction_);
}

// √(xᵀM_s x), M_s with the stand-ins of bodies without mass.
double ConstrainedEquations::calc_metric_size(const Eigen::VectorXd& x) {
  double sum = 0.0;
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    const int first = body.first_coordinate, size = body.num_coordinates();
    momentum_.segment(first, size).noalias() = terms_.mass(b) * x.segment(first, size);
    sum += x.segment(first, size).dot(momentum_.segment(first, size)) +
           body.stand_in_mass * x.segment<2>(first).squaredNorm() +
           body.stand_in_inertia * x[first + 2] * x[first + 2];
  }
  sum += x.tail(model_->num_states()).squaredNorm();
  return std::sqrt(sum);
}

// Brings v_dot_ and lambda_ nearer to the solution: a solution for what is missing in both equations, with
// M_s for M. The factors are up to date. The change of v_dot_ is then in change_.
void ConstrainedEquations::improve_accelerations() {
  change_ = terms_.forces();
  impulse_ = -lambda_;
  terms_.jacobian().add_transposed_product(impulse_, change_);
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const int first = model_->bodies[b].first_coordinate, size = model_->bodies[b].num_coordinates();
    change_.segment(first, size).noalias() -= terms_.mass(b) * v_dot_.segment(first, size);
  }
  change_.tail(model_->num_states()) -= v_dot_.tail(model_->num_states());
  apply_inverse_mass(change_);
  v_dot_ += change_;
  if (model_->num_constraints == 0) return;
  terms_.calc_gamma(violation_);
  violation_ = -violation_;
  terms_.jacobian().add_product(v_dot_, violation_);
  calc_correction();
  lambda_ += impulse_;
  v_dot_ -= correction_;
  change_ -= correction_;
}

// Bodies without mass: M has no inverse, but with M_s in its place the error of a solution falls to the share
// of the stand-ins in the mass that moves (system, eq. 13). Without stand-ins it falls to rounding.
bool ConstrainedEquations::solve_by_improvement() {
  if (model_->num_constraints > 0 && !factorise()) return false;
  v_dot_.setZero();
  lambda_.setZero();
  change_ = terms_.forces();
  apply_inverse_mass(change_);
  const double from_forces = std::sqrt(change_.dot(terms_.forces()));
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMaxImprovements; ++iteration) {
    improve_accelerations();
    const double change = calc_metric_size(change_);
    if (!std::isfinite(change)) return false;
    const bool is_rounding = !model_->has_massless_bodies && change > 0.5 * last;
    if (is_rounding || change <= kExact * (calc_metric_size(v_dot_) + from_forces)) return v_dot_.allFinite();
    last = change;
  }
  return false;
}

// With a₀ = M⁻¹Q: (φ_q M⁻¹ φ_qᵀ) λ = φ_q a₀ − γ, q̈ = a₀ − M⁻¹φ_qᵀλ.
bool ConstrainedEquations::update_accelerations(std::span<const int> branches) {
  terms_.update_mass();
  terms_.update_forces(branches);
  if (model_->has_light_bodies) {
    if (!solve_by_improvement()) return false;
    terms_.set_has_accelerations();
    return true;
  }
  v_dot_ = terms_.forces();
  apply_inverse_mass(v_dot_);
  if (model_->num_constraints > 0) {
    terms_.calc_gamma(violation_);
    violation_ = -violation_;
    terms_.jacobian().add_product(v_dot_, violation_);
    if (!factorise()) return false;
    calc_correction();
    lambda_ = impulse_;
    v_dot_ -= correction_;
  }
  if (!v_dot_.allFinite()) return false;
  terms_.set_has_accelerations();
  return true;
}

void ConstrainedEquations::set_motion(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                      const Eigen::VectorXd& v_dot, const Eigen::VectorXd& lambda,
                                      std::span<const int> branches) {
  terms_.update_positions(time, q);
  terms_.update_jacobian();
  terms_.update_mass();
  terms_.update_velocities(v);
  terms_.update_forces(branches);
  v_dot_ = v_dot;
  lambda_ = lambda;
  terms_.set_has_accelerations();
}

double ConstrainedEquations::calc_motion_power() {
  if (!model_->has_moving_joints) return 0.0;
  terms_.calc_time_rate(motion_rate_);
  return lambda_.dot(motion_rate_);
}

bool ConstrainedEquations::close_joints(double time, const Eigen::VectorXd& q) {
  terms_.update_positions(time, q);
  if (model_->num_constraints == 0) {
    terms_.update_jacobian();  // it has no row, but counts as up to date
    return true;
  }
  closing_q_ = q;
  for (int iteration = 0; iteration < kMaxClosings; ++iteration) {
    terms_.calc_residual(violation_);
    terms_.update_jacobian();
    const double size = violation_.lpNorm<Eigen::Infinity>();
    if (!violation_.allFinite()) return false;  // the norm may pass over a NaN
    if (size <= kClosed * model_->length_scale) return true;
    if (iteration >= kClosingsToRounding && size <= model_->calc_rounding(closing_q_)) return true;
    terms_.update_mass();
    if (!factorise()) return false;
    calc_correction();
    closing_q_ -= correction_;
    terms_.update_positions(time, closing_q_);
  }
  return false;
}

void ConstrainedEquations::calc_response(const Eigen::VectorXd& force, Eigen::VectorXd& x) {
  x = force;
  apply_inverse_mass(x);
  if (model_->num_constraints == 0) return;
  violation_.setZero();
  terms_.jacobian().add_product(x, violation_);
  calc_correction();
  x -= correction_;
}

double ConstrainedEquations::close_rates(const Eigen::VectorXd& v) {
  if (model_->num_constraints == 0) {
    terms_.update_velocities(v);
    return 0.0;
  }
  terms_.update_mass();
  if (!factorise()) return std::numeric_limits<double>::quiet_NaN();
  closing_v_ = v;
  double violation = 0.0;
  for (int pass = 0; pass < 2; ++pass) {  // the second removes the rounding of the first
    terms_.calc_time_rate(violation_);
    terms_.jacobian().add_product(closing_v_, violation_);
    if (pass == 0) violation = violation_.lpNorm<Eigen::Infinity>();
    calc_correction();
    closing_v_ -= correction_;
  }
  terms_.update_velocities(closing_v_);
  return violation;
}

}  // namespace sprung::dynamics

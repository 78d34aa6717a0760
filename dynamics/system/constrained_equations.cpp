#include "dynamics/system/constrained_equations.h"

#include <cmath>
#include <limits>

namespace sprung::dynamics {

namespace {

constexpr double kClosed = 1e-12;  // of the model's length scale
constexpr int kMaxClosings = 12;
constexpr int kClosingsToRounding = 3;  // after which coordinates are as good as their rounding allows

}  // namespace

ConstrainedEquations::ConstrainedEquations(const Model& model, SystemTerms::Markers scope)
    : model_(&model), terms_(model, scope), multipliers_(terms_.jacobian(), model.num_constraints) {
  v_dot_ = moved_ = step_ = Eigen::VectorXd::Zero(model.num_coordinates);
  lambda_ = residual_ = impulse_ = Eigen::VectorXd::Zero(model.num_constraints);
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

// step_ = M⁻¹φ_qᵀ (φ_q M⁻¹ φ_qᵀ)⁻¹ residual_, the multipliers in impulse_.
void ConstrainedEquations::calc_correction() {
  multipliers_.solve(residual_, impulse_);
  step_.setZero();
  terms_.jacobian().add_transposed_product(impulse_, step_);
  apply_inverse_mass(step_);
}

// With a₀ = M⁻¹Q: (φ_q M⁻¹ φ_qᵀ) λ = φ_q a₀ − γ, q̈ = a₀ − M⁻¹φ_qᵀλ.
bool ConstrainedEquations::update_accelerations(std::span<const int> branches) {
  terms_.update_mass();
  terms_.update_forces(branches);
  v_dot_ = terms_.forces();
  apply_inverse_mass(v_dot_);
  if (model_->num_constraints > 0) {
    terms_.calc_gamma(residual_);
    residual_ = -residual_;
    terms_.jacobian().add_product(v_dot_, residual_);
    if (!factorise()) return false;
    calc_correction();
    lambda_ = impulse_;
    v_dot_ -= step_;
  }
  return v_dot_.allFinite();
}

double ConstrainedEquations::calc_motion_power() {
  if (!model_->has_motions) return 0.0;
  terms_.calc_time_rate(residual_);
  return lambda_.dot(residual_);
}

bool ConstrainedEquations::close_joints(double time, const Eigen::VectorXd& q) {
  terms_.update_positions(time, q);
  if (model_->num_constraints == 0) return true;
  moved_ = q;
  for (int iteration = 0; iteration < kMaxClosings; ++iteration) {
    terms_.calc_residual(residual_);
    terms_.update_jacobian();
    const double size = residual_.lpNorm<Eigen::Infinity>();
    if (!residual_.allFinite()) return false;  // the largest one may pass over what is no number
    if (size <= kClosed * model_->length_scale) return true;
    if (iteration >= kClosingsToRounding && size <= model_->calc_rounding(moved_)) return true;
    terms_.update_mass();
    if (!factorise()) return false;
    calc_correction();
    moved_ -= step_;
    terms_.update_positions(time, moved_);
  }
  return false;
}

double ConstrainedEquations::close_rates(const Eigen::VectorXd& v) {
  if (model_->num_constraints == 0) {
    terms_.update_velocities(v);
    return 0.0;
  }
  terms_.update_mass();
  if (!factorise()) return std::numeric_limits<double>::quiet_NaN();
  moved_ = v;
  double violation = 0.0;
  for (int pass = 0; pass < 2; ++pass) {  // the second removes the rounding of the first
    terms_.calc_time_rate(residual_);
    terms_.jacobian().add_product(moved_, residual_);
    if (pass == 0) violation = residual_.lpNorm<Eigen::Infinity>();
    calc_correction();
    moved_ -= step_;
  }
  terms_.update_velocities(moved_);
  return violation;
}

}  // namespace sprung::dynamics

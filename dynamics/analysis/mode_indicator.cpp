#include "dynamics/analysis/mode_indicator.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "dynamics/analysis/linearisation.h"
#include "dynamics/analysis/oscillator_response.h"
#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kSmallestDeflection = 1e-7;     // of the model's length scale, that shares refer to
constexpr double kSmallestAcceleration = 1e-2;   // of gravity

}  // namespace

ModeIndicator::ModeIndicator(const Model& full, double time, const Eigen::VectorXd& q, std::vector<int> points)
    : full_(&full), terms_(full), points_(std::move(points)) {
  for (const Body& body : full.bodies) {
    for (int k = 0; k < body.num_modes(); ++k) modal_.push_back(body.first_coordinate + 3 + k);
  }
  const std::size_t n = modal_.size();
  active_.assign(n, false);
  effective_.assign(n, Eigen::Vector3d::Zero());
  reach_.assign(n, 0.0);
  for (const int coordinate : modal_) {
    double largest = 0.0;
    for (const Marker& marker : full.markers) {
      if (marker.body == kGround) continue;
      const int k = coordinate - full.bodies[static_cast<std::size_t>(marker.body)].first_coordinate - 3;
      if (k >= 0 && k < marker.Phi.cols()) largest = std::max(largest, marker.Phi.col(k).norm());
    }
    bending_.push_back(largest);
  }
  oscillators_.assign(n, Eigen::Vector3d::Zero());
  neglected_.assign(n, {});
  residual_ = Eigen::VectorXd::Zero(full.num_coordinates);

  try {
    PartitionedEquations equations(full);
    const LinearisedSystem small = linearise(equations, time, q);
    independent_ = small.partition.independent;
    mass_ = small.mass;
    damping_ = small.damping;
    stiffness_ = small.stiffness;
    directions_ = small.directions;
  } catch (const support::NumericalError&) {
    // Near a singular position: each mode by itself, as if nothing gave way.
  }

  terms_.update_positions(time, q);
  for (const int i : points_) {
    const Marker& marker = full.markers[static_cast<std::size_t>(i)];
    Eigen::Matrix2Xd motion = Eigen::Matrix2Xd::Zero(2, full.num_coordinates);
    if (marker.body != kGround) {
      const Body& body = full.bodies[static_cast<std::size_t>(marker.body)];
      const MarkerState& state = terms_.markers()[static_cast<std::size_t>(i)];
      motion.block<2, 2>(0, body.first_coordinate).setIdentity();
      motion.col(body.first_coordinate + 2) = state.r_theta;
      motion.middleCols(body.first_coordinate + 3, body.num_modes()) = state.r_eta;
    }
    point_motion_.push_back(motion);
  }
  const double floor = std::max(full.gravity.norm(), full.length_scale);
  largest_deflection_ = kSmallestDeflection * full.length_scale;
  largest_acceleration_ = kSmallestAcceleration * floor;
  set_active(std::vector<bool>(static_cast<std::size_t>(full.num_coordinates), false));
}

void ModeIndicator::set_active(const std::vector<bool>& is_active_coordinate) {
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    const bool now = is_active_coordinate[static_cast<std::size_t>(modal_[j])];
    if (now != active_[j]) oscillators_[j].setZero();
    active_[j] = now;
    neglected_[j] = {};
  }
  for (std::size_t j = 0; j < modal_.size(); ++j) calc_effective(j);
}

// The mode with what gives way to it by inertia: the rigid motions and the active modes, x = −M_AA⁻¹ M_Aj.
void ModeIndicator::calc_effective(std::size_t mode) {
  std::vector<Eigen::Index> giving;
  Eigen::Index own = -1;
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    const auto found = std::lower_bound(modal_.begin(), modal_.end(), independent_[i]);
    const bool is_modal = found != modal_.end() && *found == independent_[i];
    if (independent_[i] == modal_[mode]) own = static_cast<Eigen::Index>(i);
    else if (!is_modal || active_[static_cast<std::size_t>(found - modal_.begin())]) giving.push_back(static_cast<Eigen::Index>(i));
  }
  const int coordinate = modal_[mode];
  Eigen::VectorXd w = Eigen::VectorXd::Zero(full_->num_coordinates);
  if (own < 0) {
    // The partition has it follow from others: by itself.
    const auto body = std::find_if(full_->bodies.begin(), full_->bodies.end(), [&](const Body& one) {
      return coordinate < one.first_coordinate + one.num_coordinates();
    });
    const Eigen::Index k = coordinate - body->first_coordinate - 3;
    effective_[mode] = {body->M_ff(k, k), body->damping(k, k), body->stiffness(k, k)};
    w[coordinate] = 1.0;
  } else {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(mass_.rows());
    if (!giving.empty()) x(giving) = -mass_(giving, giving).llt().solve(mass_(giving, own).eval());
    x[own] = 1.0;
    effective_[mode] = {x.dot(mass_ * x), std::max(0.0, x.dot(damping_ * x)), std::max(0.0, x.dot(stiffness_ * x))};
    w = directions_ * x;
  }
  reach_[mode] = 0.0;
  for (const Eigen::Matrix2Xd& motion : point_motion_) reach_[mode] = std::max(reach_[mode], (motion * w).norm());
}

double ModeIndicator::frequency(std::size_t mode) const {
  return std::sqrt(effective_[mode][2] / effective_[mode][0]) / (2.0 * std::acos(-1.0));
}

ModeShare ModeIndicator::share(std::size_t mode, double amplitude, double acceleration) const {
  // Never more than all: where the run bends less than the mode would, the mode is the deflection.
  const double deflection = bending_[mode] * std::abs(amplitude), change = reach_[mode] * std::abs(acceleration);
  return {deflection / std::max(largest_deflection_, deflection), change / std::max(largest_acceleration_, change)};
}

void ModeIndicator::update(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                           const Eigen::VectorXd& v_dot, const Eigen::VectorXd& multipliers,
                           std::span<const int> branches) {
  terms_.update_positions(time, q);
  terms_.update_jacobian();
  terms_.update_mass();
  terms_.update_velocities(v);
  terms_.update_forces(branches);
  residual_.setZero();
  terms_.jacobian().add_transposed_product(multipliers, residual_);
  residual_ = terms_.forces() - residual_;
  for (std::size_t b = 0; b < full_->bodies.size(); ++b) {
    const Body& body = full_->bodies[b];
    residual_.segment(body.first_coordinate, body.num_coordinates()) -=
        terms_.mass(b) * v_dot.segment(body.first_coordinate, body.num_coordinates());
  }

  for (const Marker& marker : full_->markers) {
    if (marker.body == kGround || marker.Phi.cols() == 0) continue;
    const int first = full_->bodies[static_cast<std::size_t>(marker.body)].first_coordinate + 3;
    Eigen::Vector2d deflection = Eigen::Vector2d::Zero();
    for (Eigen::Index k = 0; k < marker.Phi.cols(); ++k) deflection += marker.Phi.col(k) * q[first + k];
    largest_deflection_ = std::max(largest_deflection_, deflection.norm());
  }
  for (const int i : points_) {
    const Marker& marker = full_->markers[static_cast<std::size_t>(i)];
    if (marker.body == kGround) continue;
    const Body& body = full_->bodies[static_cast<std::size_t>(marker.body)];
    largest_acceleration_ = std::max(
        largest_acceleration_, calc_marker_acceleration(terms_.markers()[static_cast<std::size_t>(i)],
                                                        v_dot.segment(body.first_coordinate, body.num_coordinates()))
                                   .norm());
  }

  const double step = time - time_;
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    neglected_[j] = {};
    if (active_[j]) continue;
    const double mass = effective_[j][0], decay = 0.5 * effective_[j][1] / mass, stiffness = effective_[j][2] / mass;
    const double force = residual_[modal_[j]] / mass;
    double& x = oscillators_[j][0];
    double& rate = oscillators_[j][1];
    if (has_begun_ && step > 0.0) {
      const OscillatorResponse r = calc_oscillator_response(stiffness, decay, step);
      const double slope = (force - oscillators_[j][2]) / step, before = oscillators_[j][2];
      const double next = r.c * x + r.s * rate + r.forced[0] * before + r.forced[1] * slope;
      rate = r.c_rate * x + r.s_rate * rate + r.forced_rate(0) * before + r.forced_rate(1) * slope;
      x = next;
    }
    if (!has_begun_ && stiffness > 0.0) x = force / stiffness;  // what is missing from the start on is no vibration
    oscillators_[j][2] = force;
    // Amplitude rather than instant, which may pass through zero; and what the force would do for good.
    const double amplitude = stiffness > 0.0 ? std::max(std::sqrt(x * x + rate * rate / stiffness), std::abs(force) / stiffness)
                                             : std::abs(x);
    const double acceleration = std::hypot(force - 2.0 * decay * rate - stiffness * x, std::sqrt(stiffness) * rate);
    neglected_[j] = share(j, amplitude, acceleration);
  }
  time_ = time;
  has_begun_ = true;
}

ModeIndicator::Memory ModeIndicator::remember() const {
  return {time_, has_begun_, oscillators_, largest_deflection_, largest_acceleration_};
}

void ModeIndicator::go_back(const Memory& memory) {
  time_ = memory.time;
  has_begun_ = memory.has_begun;
  oscillators_ = memory.oscillators;
  largest_deflection_ = memory.largest_deflection;
  largest_acceleration_ = memory.largest_acceleration;
}

}  // namespace sprung::dynamics

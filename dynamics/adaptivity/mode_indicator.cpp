#include "dynamics/adaptivity/mode_indicator.h"

#include <algorithm>
#include <cmath>

#include "tools/support/dense/dense_solvers.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kSmallestDeflection = 1e-5;    // of the model's length scale, that shares refer to
constexpr double kSmallestAcceleration = 1e-2;  // of gravity
constexpr double kSameStep = 1e-9;              // relative: times of equal steps differ by rounding

}  // namespace

ModeIndicator::ModeIndicator(const Model& full, double time, const Eigen::VectorXd& q,
                             std::vector<int> points, const LinearisedSystem* linearised)
    : full_(&full), unbalanced_(full), points_(std::move(points)), time_(time) {
  for (const Body& body : full.bodies) {
    for (int k = 0; k < body.num_modes(); ++k) modal_.push_back(body.first_coordinate + 3 + k);
  }
  const std::size_t n = modal_.size();
  active_.assign(n, false);
  effective_.resize(n);
  for (const int coordinate : modal_) {
    double largest = 0.0;
    for (const Marker& marker : full.markers) {
      if (marker.body == kGround) continue;
      const int k = coordinate - full.bodies[static_cast<std::size_t>(marker.body)].first_coordinate - 3;
      if (k >= 0 && k < marker.Phi.cols()) largest = std::max(largest, marker.Phi.col(k).head<2>().norm());
    }
    bending_.push_back(largest);
  }
  oscillators_.resize(n);
  left_out_.resize(n);
  neglected_.resize(n);
  stack_shapes();

  Eigen::MatrixXd directions;
  try {
    std::optional<LinearisedSystem> found;
    if (!linearised) {
      PartitionedEquations equations(full);
      linearised = &found.emplace(linearise(equations, time, q));
    }
    const LinearisedSystem& small = *linearised;
    independent_ = small.partition.independent;
    mass_ = small.mass;
    damping_ = small.damping;
    stiffness_ = small.stiffness;
    directions = small.directions;
  } catch (const support::NumericalError&) {
    // Near a singular position: each mode by itself, as if nothing gave way.
  }

  SystemTerms terms(full);
  terms.update_positions(time, q);
  for (const int i : points_) {
    const Marker& marker = full.markers[static_cast<std::size_t>(i)];
    Eigen::Matrix2Xd motion = Eigen::Matrix2Xd::Zero(2, full.num_coordinates);
    if (marker.body != kGround) {
      const Body& body = full.bodies[static_cast<std::size_t>(marker.body)];
      const MarkerState& state = terms.markers()[static_cast<std::size_t>(i)];
      motion.block<2, 2>(0, body.first_coordinate).setIdentity();
      motion.col(body.first_coordinate + 2) = state.r_theta;
      motion.middleCols(body.first_coordinate + 3, body.num_modes()) = state.r_eta();
    }
    point_motion_.push_back(motion);
    point_states_.push_back(terms.markers()[static_cast<std::size_t>(i)]);
  }
  const double floor = std::max(full.gravity.norm(), full.length_scale);
  largest_deflection_ = kSmallestDeflection * full.length_scale;
  largest_acceleration_.assign(points_.size(), kSmallestAcceleration * floor);
  for (const Eigen::Matrix2Xd& motion : point_motion_) {
    if (!independent_.empty()) reduced_motion_.push_back(motion * directions);
  }
  update_effective();
}

// Of all markers of a body, one below the other.
void ModeIndicator::stack_shapes() {
  Eigen::Index most = 0;
  for (std::size_t b = 0; b < full_->bodies.size(); ++b) {
    std::vector<const Marker*> markers;
    for (const Marker& marker : full_->markers) {
      if (marker.body == static_cast<int>(b) && marker.Phi.cols() > 0) markers.push_back(&marker);
    }
    const auto rows = static_cast<Eigen::Index>(2 * markers.size());
    shapes_.emplace_back(rows, markers.empty() ? 0 : full_->bodies[b].num_modes());
    for (std::size_t i = 0; i < markers.size(); ++i) {
      shapes_.back().middleRows<2>(2 * static_cast<Eigen::Index>(i)) = markers[i]->Phi.topRows<2>();
    }
    most = std::max(most, rows);
  }
  deflections_ = Eigen::VectorXd::Zero(most);
}

void ModeIndicator::set_active(const std::vector<bool>& is_active_coordinate) {
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    const bool now = is_active_coordinate[static_cast<std::size_t>(modal_[j])];
    if (now != active_[j]) oscillators_[j] = {.is_fresh = has_begun_};
    active_[j] = now;
    left_out_[j] = {};
    neglected_[j] = {};
  }
  const std::vector<Effective> before = effective_;
  update_effective();
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    Oscillator& one = oscillators_[j];
    if (before[j].stiffness > 0.0 && effective_[j].stiffness > 0.0) {
      one.place += one.force / effective_[j].stiffness - one.force / before[j].stiffness;
    }
  }
}

// Places in independent_ of all but modes left out.
std::vector<Eigen::Index> ModeIndicator::find_free(const std::vector<bool>& active) const {
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    const auto found = std::lower_bound(modal_.begin(), modal_.end(), independent_[i]);
    const bool is_modal = found != modal_.end() && *found == independent_[i];
    if (!is_modal || active[static_cast<std::size_t>(found - modal_.begin())])
      free.push_back(static_cast<Eigen::Index>(i));
  }
  return free;
}

// The rigid motions and the active modes A give way by their inertia: x = −M_AA⁻¹ M_Aj for a mode left out;
// for an active one, which the others give way to, x = M_AA⁻¹ e_j over its own entry.
void ModeIndicator::update_effective() {
  const std::vector<Eigen::Index> giving = find_free(active_);
  const auto n = static_cast<Eigen::Index>(modal_.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(mass_.rows(), n);
  std::vector<Eigen::Index> own(modal_.size(), -1);
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    const auto found = std::find(independent_.begin(), independent_.end(), modal_[j]);
    if (found == independent_.end()) continue;
    own[j] = found - independent_.begin();
    const auto column = static_cast<Eigen::Index>(j);
    if (active_[j]) {
      x(own[j], column) = 1.0;
    } else {
      x.col(column) = -mass_.col(own[j]);
    }
  }
  const Eigen::MatrixXd part = support::solve_positive_definite(mass_(giving, giving), x(giving, Eigen::all));
  x.setZero();
  x(giving, Eigen::all) = part;
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    if (own[j] < 0) continue;
    auto column = x.col(static_cast<Eigen::Index>(j));
    if (active_[j]) {
      column /= column[own[j]];
    } else {
      column[own[j]] = 1.0;
    }
  }
  const Eigen::VectorXd mass = x.cwiseProduct(mass_ * x).colwise().sum();
  const Eigen::VectorXd damping = x.cwiseProduct(damping_ * x).colwise().sum();
  const Eigen::VectorXd stiffness = x.cwiseProduct(stiffness_ * x).colwise().sum();
  std::vector<Eigen::MatrixXd> reach;
  for (const Eigen::MatrixXd& motion : reduced_motion_) reach.push_back(motion * x);
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    if (own[j] < 0) {
      effective_[j] = make_alone(modal_[j]);
      continue;
    }
    const auto column = static_cast<Eigen::Index>(j);
    effective_[j] = {.mass = mass[column],
                     .damping = std::max(0.0, damping[column]),
                     .stiffness = std::max(0.0, stiffness[column])};
    for (const Eigen::MatrixXd& motion : reach) effective_[j].reach.push_back(motion.col(column).norm());
  }
}

// A mode that the partition has follow from others, or all where there is none: as if nothing gave way.
ModeIndicator::Effective ModeIndicator::make_alone(int coordinate) const {
  const auto body = std::find_if(full_->bodies.begin(), full_->bodies.end(), [&](const Body& one) {
    return coordinate < one.first_coordinate + one.num_coordinates();
  });
  const Eigen::Index k = coordinate - body->first_coordinate - 3;
  Effective effective{body->M_ff(k, k), body->damping(k, k), body->stiffness(k, k)};
  for (const Eigen::Matrix2Xd& motion : point_motion_)
    effective.reach.push_back(motion.col(coordinate).norm());
  return effective;
}

double ModeIndicator::frequency(std::size_t mode) const {
  return std::sqrt(effective_[mode].stiffness / effective_[mode].mass) / (2.0 * std::acos(-1.0));
}

// Never more than all: where the run bends less than the mode would, the mode is the deflection.
template <class Change>
ModeShare ModeIndicator::calc_share(double deflection, const Change& change_at) const {
  ModeShare share{.deflection = deflection / std::max(largest_deflection_, deflection)};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double change = change_at(i);
    share.acceleration = std::max(share.acceleration, change / std::max(largest_acceleration_[i], change));
  }
  return share;
}

ModeShare ModeIndicator::share(std::size_t mode, double amplitude, double acceleration) const {
  return calc_share(bending_[mode] * std::abs(amplitude),
                    [&](std::size_t i) { return effective_[mode].reach[i] * std::abs(acceleration); });
}

void ModeIndicator::calc_reached(std::size_t mode, const LeftOut& left_out, Reached& reached) const {
  reached.deflection = bending_[mode] * left_out.amplitude;
  reached.acceleration.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    reached.acceleration[i] = effective_[mode].reach[i] * left_out.acceleration;
  }
}

ModeShare ModeIndicator::share(const Reached& reached) const {
  return calc_share(reached.deflection, [&](std::size_t i) { return reached.acceleration[i]; });
}

std::optional<KnownMotion> ModeIndicator::calc_small_motion(const HeldModes& held) const {
  KnownMotion known;
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    const auto place = std::lower_bound(held.coordinates.begin(), held.coordinates.end(), independent_[i]);
    if (place == held.coordinates.end() || *place != independent_[i]) continue;
    free.push_back(static_cast<Eigen::Index>(i));
    known.independent.push_back(static_cast<int>(place - held.coordinates.begin()));
  }
  const std::size_t num_held = static_cast<std::size_t>(full_->num_coordinates) - held.coordinates.size();
  if (independent_.empty() || independent_.size() - free.size() != num_held) return std::nullopt;
  known.motion = {mass_(free, free), damping_(free, free), stiffness_(free, free)};
  return known;
}

void ModeIndicator::update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot) {
  unbalanced_.update(run.terms(), run.multipliers(), q, v, v_dot);
  raise_references(q, v, v_dot);
  const double step = has_begun_ ? time - time_ : 0.0;
  for (std::size_t j = 0; j < modal_.size(); ++j) {
    if (!active_[j]) follow(j, step);
  }
  time_ = time;
  has_begun_ = true;
}

// Brings the largest deflection and acceleration so far up to date.
void ModeIndicator::raise_references(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                     const Eigen::VectorXd& v_dot) {
  for (std::size_t b = 0; b < full_->bodies.size(); ++b) {
    if (shapes_[b].cols() == 0) continue;
    auto deflections = deflections_.head(shapes_[b].rows());
    deflections.noalias() = shapes_[b] * q.segment(full_->bodies[b].first_coordinate + 3, shapes_[b].cols());
    double square = 0.0;
    for (Eigen::Index i = 0; i < deflections.size(); i += 2)
      square = std::max(square, deflections.segment<2>(i).squaredNorm());
    largest_deflection_ = std::max(largest_deflection_, std::sqrt(square));
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Marker& marker = full_->markers[static_cast<std::size_t>(points_[i])];
    if (marker.body == kGround) continue;
    const Body& body = full_->bodies[static_cast<std::size_t>(marker.body)];
    const int first = body.first_coordinate, size = body.num_coordinates();
    const FrameRotation rotation = FrameRotation::from_angle(q[first + 2]);
    calc_marker_position(marker, rotation, q.data() + first, point_states_[i]);
    calc_marker_velocity(marker, v.data() + first, point_states_[i]);
    const double acceleration = calc_marker_acceleration(point_states_[i], v_dot.segment(first, size)).norm();
    largest_acceleration_[i] = std::max(largest_acceleration_[i], acceleration);
  }
}

// One mode left out, over a step in which the force went straight to where it is now.
void ModeIndicator::follow(std::size_t mode, double step) {
  Effective& effective = effective_[mode];
  const double mass = effective.mass, decay = 0.5 * effective.damping / mass,
               stiffness = effective.stiffness / mass;
  Oscillator& one = oscillators_[mode];
  const double before = one.force / mass;
  one.force = unbalanced_.force()[modal_[mode]];
  if (step > 0.0 || one.is_fresh) one.held_force = one.force;
  one.is_fresh = false;
  const double force = one.force / mass;
  if (step > 0.0) {
    if (std::abs(step - effective.step) > kSameStep * step) {
      effective.response = calc_oscillator_response(stiffness, decay, step, 1);
      effective.step = step;
    }
    const OscillatorResponse& r = effective.response;
    const double slope = (force - before) / step, place = one.place, rate = one.rate;
    one.place = r.c * place + r.s * rate + r.forced[0] * before + r.forced[1] * slope;
    one.rate = r.c_rate * place + r.s_rate * rate + r.forced_rate(0) * before + r.forced_rate(1) * slope;
  }
  if (!has_begun_ && stiffness > 0.0)
    one.place = force / stiffness;  // what is missing from the start on is no vibration
  // Amplitude rather than instant, which may pass through zero; and what the force would do for good.
  const double amplitude = stiffness > 0.0
                               ? std::max(std::sqrt(one.place * one.place + one.rate * one.rate / stiffness),
                                          std::abs(force) / stiffness)
                               : std::abs(one.place);
  const double acceleration =
      std::hypot(force - 2.0 * decay * one.rate - stiffness * one.place, std::sqrt(stiffness) * one.rate);
  left_out_[mode] = {amplitude, acceleration};
  neglected_[mode] = share(mode, amplitude, acceleration);
}

void ModeIndicator::remember(Memory& memory) const {
  memory.time = time_;
  memory.has_begun = has_begun_;
  memory.oscillators = oscillators_;
}

void ModeIndicator::go_back(const Memory& memory) {
  time_ = memory.time;
  has_begun_ = memory.has_begun;
  oscillators_ = memory.oscillators;
}

}  // namespace sprung::dynamics

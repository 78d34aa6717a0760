#include "dynamics/adaptivity/effective_modes.h"

#include <algorithm>
#include <cmath>

#include "tools/support/dense/dense_solvers.h"

namespace sprung::dynamics {

namespace {

double calc_largest_deflection(const Model& full, int coordinate) {
  double largest = 0.0;
  for (const Marker& marker : full.markers) {
    if (marker.body == kGround) continue;
    const int k = coordinate - full.bodies[static_cast<std::size_t>(marker.body)].first_coordinate - 3;
    if (k >= 0 && k < marker.Phi.cols()) largest = std::max(largest, marker.Phi.col(k).head<2>().norm());
  }
  return largest;
}

void add_point(const Eigen::Vector2d& motion, EffectiveModes::Mode& mode) {
  mode.reach.push_back(motion.norm());
  mode.motion.push_back(motion);
}

}  // namespace

EffectiveModes::EffectiveModes(const FullSmallMotion& motion, const std::vector<bool>& is_active)
    : motion_(&motion) {
  for (const int coordinate : motion.modal_coordinates()) {
    modes_.push_back({.deflection = calc_largest_deflection(motion.model(), coordinate)});
    own_.push_back(motion.find_independent(coordinate));
  }
  update(is_active);
}

// Motion x of the independent coordinates per unit of each mode, f×modes. The rigid motions and the active
// modes A give way by their inertia: x = −M_AA⁻¹ M_Aj for a mode left out; for an active one, to which the
// others give way, x = M_AA⁻¹ e_j over its own entry.
Eigen::MatrixXd EffectiveModes::calc_directions(const std::vector<bool>& is_active) const {
  const Eigen::MatrixXd& mass = motion_->motion().mass;
  const std::vector<Eigen::Index> giving = motion_->find_free(is_active);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(mass.rows(), static_cast<Eigen::Index>(modes_.size()));
  for (std::size_t j = 0; j < modes_.size(); ++j) {
    if (own_[j] < 0) continue;
    const auto column = static_cast<Eigen::Index>(j);
    if (is_active[j]) {
      x(own_[j], column) = 1.0;
    } else {
      x.col(column) = -mass.col(own_[j]);
    }
  }
  const Eigen::MatrixXd part = support::solve_positive_definite(mass(giving, giving), x(giving, Eigen::all));
  x.setZero();
  x(giving, Eigen::all) = part;
  for (std::size_t j = 0; j < modes_.size(); ++j) {
    if (own_[j] < 0) continue;
    auto column = x.col(static_cast<Eigen::Index>(j));
    if (is_active[j]) {
      column /= column[own_[j]];
    } else {
      column[own_[j]] = 1.0;
    }
  }
  return x;
}

void EffectiveModes::update(const std::vector<bool>& is_active) {
  const Eigen::MatrixXd x = calc_directions(is_active);
  const auto& [M, C, K] = motion_->motion();
  const Eigen::VectorXd mass = x.cwiseProduct(M * x).colwise().sum();
  const Eigen::VectorXd damping = x.cwiseProduct(C * x).colwise().sum();
  const Eigen::VectorXd stiffness = x.cwiseProduct(K * x).colwise().sum();
  std::vector<Eigen::MatrixXd> reach;
  for (std::size_t i = 0; i < motion_->num_points(); ++i) reach.emplace_back(motion_->reduced_motion(i) * x);
  for (std::size_t j = 0; j < modes_.size(); ++j) {
    const double deflection = modes_[j].deflection;
    if (own_[j] < 0) {
      modes_[j] = make_lone_mode(motion_->modal_coordinates()[j]);
    } else {
      const auto column = static_cast<Eigen::Index>(j);
      modes_[j] = {.mass = mass[column],
                   .damping = std::max(0.0, damping[column]),
                   .stiffness = std::max(0.0, stiffness[column])};
      for (const Eigen::MatrixXd& motion : reach) add_point(motion.col(column), modes_[j]);
    }
    modes_[j].deflection = deflection;
  }
}

// A mode to which nothing gives way: for dependent modes, and for all where there is no small motion.
EffectiveModes::Mode EffectiveModes::make_lone_mode(int coordinate) const {
  const std::vector<Body>& bodies = motion_->model().bodies;
  const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const Body& one) {
    return coordinate < one.first_coordinate + one.num_coordinates();
  });
  const Eigen::Index k = coordinate - body->first_coordinate - 3;
  Mode mode{.mass = body->M_ff(k, k), .damping = body->damping(k, k), .stiffness = body->stiffness(k, k)};
  for (std::size_t i = 0; i < motion_->num_points(); ++i) {
    add_point(motion_->point_motion(i).col(coordinate), mode);
  }
  return mode;
}

double EffectiveModes::calc_frequency(std::size_t mode) const {
  return std::sqrt(modes_[mode].stiffness / modes_[mode].mass) / (2.0 * std::acos(-1.0));
}

}  // namespace sprung::dynamics

#include "dynamics/adaptivity/effective_modes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kSameRate = 1e-3;  // of σ
constexpr int kMostIterations = 30;

// The motion y of the vibrations with the values λ that goes with its own rate σ = k/m.
// @param find  y for a σ   @param calc_rate  k/m of a y
template <class Find, class CalcRate>
Eigen::ArrayXd iterate(double sigma, Find find, CalcRate calc_rate) {
  Eigen::ArrayXd y;
  for (int i = 0; i < kMostIterations; ++i) {
    y = find(sigma);
    const double before = sigma;
    sigma = calc_rate(y);
    if (std::abs(sigma - before) < kSameRate * sigma) break;
  }
  return y;
}

// Stiffness or mass of a mode left out, and its coupling to each vibration.
struct Coupling {
  double own;
  const Eigen::ArrayXd& others;
};

// How the vibrations of what is active follow a mode left out: yᵀ(Λ + σ)y + 2yᵀ(g + σh) is the least.
Eigen::ArrayXd find_following(const Eigen::ArrayXd& lambda, Coupling stiffness, Coupling mass, double sigma) {
  const Eigen::ArrayXd &g = stiffness.others, &h = mass.others;
  return iterate(
      sigma,
      [&](double s) -> Eigen::ArrayXd {
        return -(g + s * h) / (lambda + s).max(std::numeric_limits<double>::min());
      },
      [&](const Eigen::ArrayXd& y) {
        return (stiffness.own + (y * (2.0 * g + lambda * y)).sum()) / (mass.own + (y * (2.0 * h + y)).sum());
      });
}

// The vibrations of what is active that move an active mode by one, to which all others give way: yᵀ(Λ + σ)y
// is the least with pᵀy = 1. @param p  of the mode, per unit of each vibration
Eigen::ArrayXd find_pushed(const Eigen::ArrayXd& lambda, const Eigen::ArrayXd& p, double sigma) {
  return iterate(
      sigma,
      [&](double s) -> Eigen::ArrayXd {
        const Eigen::ArrayXd y = p / (lambda + s).max(std::numeric_limits<double>::min());
        return y / (p * y).sum();
      },
      [&](const Eigen::ArrayXd& y) { return (lambda * y.square()).sum() / y.square().sum(); });
}

double calc_largest_deflection(const Model& full, int coordinate) {
  double largest = 0.0;
  for (const Marker& marker : full.markers) {
    if (marker.body == kGround) continue;
    const int k = coordinate - full.bodies[static_cast<std::size_t>(marker.body)].first_coordinate - 3;
    if (k >= 0 && k < marker.Phi.cols()) largest = std::max(largest, marker.Phi.col(k).head<2>().norm());
  }
  return largest;
}

}  // namespace

EffectiveModes::EffectiveModes(const FullSmallMotion& motion, const std::vector<bool>& is_active)
    : motion_(&motion) {
  for (const int coordinate : motion.modal_coordinates()) {
    modes_.push_back({.deflection = calc_largest_deflection(motion.model(), coordinate)});
    own_.push_back(motion.find_independent(coordinate));
    const Mode lone = make_lone_mode(coordinate);
    own_rates_.push_back(lone.stiffness / lone.mass);
  }
  update(is_active);
}

// Motion x of the independent coordinates per unit of each mode, f×modes.
Eigen::MatrixXd EffectiveModes::calc_directions(const std::vector<bool>& is_active) const {
  const Eigen::MatrixXd& M = motion_->motion().mass;
  const Eigen::MatrixXd K = 0.5 * (motion_->motion().stiffness + motion_->motion().stiffness.transpose());
  const std::vector<Eigen::Index> giving = motion_->find_free(is_active);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(M.rows(), static_cast<Eigen::Index>(modes_.size()));
  const auto vibrations = support::solve_undamped(K(giving, giving), M(giving, giving));
  if (!vibrations) throw support::NumericalError("the modes of small motion were not found");
  const Eigen::ArrayXd lambda = vibrations->values.array().max(0.0);
  const Eigen::MatrixXd& V = vibrations->vectors;
  for (std::size_t j = 0; j < modes_.size(); ++j) {
    const Eigen::Index own = own_[j];
    if (own < 0) continue;
    Eigen::ArrayXd y;
    if (is_active[j]) {
      const auto place = std::find(giving.begin(), giving.end(), own) - giving.begin();
      y = find_pushed(lambda, V.row(place).transpose(), own_rates_[j]);
    } else {
      const Eigen::ArrayXd g = V.transpose() * K(giving, own), h = V.transpose() * M(giving, own);
      y = find_following(lambda, {K(own, own), g}, {M(own, own), h}, own_rates_[j]);
    }
    auto column = x.col(static_cast<Eigen::Index>(j));
    column(giving) = V * y.matrix();
    column[own] = 1.0;
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
      for (const Eigen::MatrixXd& motion : reach) modes_[j].reach.push_back(motion.col(column).norm());
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
  for (std::size_t i = 0; i < motion_->num_points(); ++i)
    mode.reach.push_back(motion_->point_motion(i).col(coordinate).norm());
  return mode;
}

double EffectiveModes::calc_frequency(std::size_t mode) const {
  return std::sqrt(modes_[mode].stiffness / modes_[mode].mass) / (2.0 * std::numbers::pi);
}

}  // namespace sprung::dynamics

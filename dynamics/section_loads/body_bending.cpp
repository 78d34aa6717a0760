#include "dynamics/section_loads/body_bending.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

namespace {

// Axial forces change the lowest modes of a body most; more of them would cost more than they tell.
constexpr Eigen::Index kMostModes = 12;
// A mode is one of axial deformation alone if axial forces change its stiffness by less than this share of
// what they change in the middle one of the modes that they work on. Its strain energy, which is large in a
// column, says nothing about bending.
constexpr double kUnaffected = 1e-3;
// Squares of deflections above the largest by less than this are the same: a body at rest stays at its first.
constexpr double kBeyondRounding = 1.0 + 1e-12;

double calc_length(const Eigen::Matrix2Xd& nodes) {
  return (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
}

// K_G of the lowest m active modes under unit loads: each a column of m².
Eigen::MatrixXd make_geometric(const Body& body, const reduce::GeometricStiffness& geometric,
                               const BodyLoads& loads) {
  std::vector<int> columns;
  for (const int number : body.mode_numbers) {
    if (number <= geometric.num_modes() && static_cast<Eigen::Index>(columns.size()) < kMostModes)
      columns.push_back(number - 1);
  }
  const auto m = static_cast<Eigen::Index>(columns.size());
  const auto flatten = [&](const Eigen::MatrixXd& K) {
    const Eigen::MatrixXd chosen = K(columns, columns);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(chosen.data(), m * m));
  };
  const auto num_points = static_cast<Eigen::Index>(geometric.point_loads.size());
  Eigen::MatrixXd of_points(m * m, 3 * num_points), of_frame(m * m, 4);
  for (Eigen::Index p = 0; p < num_points; ++p) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      of_points.col(3 * p + i) =
          flatten(geometric.point_loads[static_cast<std::size_t>(p)][static_cast<std::size_t>(i)]);
    }
  }
  of_frame << flatten(geometric.acceleration[0]), flatten(geometric.acceleration[1]),
      flatten(geometric.angular_acceleration), flatten(geometric.centrifugal);
  return loads.combine(of_points, of_frame);
}

// The value where half of the weight is of lower ones.
double find_middle(const Eigen::VectorXd& values, const Eigen::VectorXd& weights) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index i, Eigen::Index k) { return values[i] < values[k]; });
  double weight = 0.0;
  for (const Eigen::Index i : order) {
    weight += weights[i];
    if (weight >= 0.5 * weights.sum()) return values[i];
  }
  return 0.0;
}

}  // namespace

BodyBending::BodyBending(const Body& body, const reduce::Superelement& superelement, const BodyLoads& loads)
    : name_(body.name),
      first_(body.first_coordinate + 3),
      num_modes_(body.num_modes()),
      length_(calc_length(superelement.node_positions)) {
  const Eigen::Index num_nodes = superelement.num_nodes();
  shapes_.resize(2 * num_nodes, num_modes_);
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    for (int k = 0; k < num_modes_; ++k) {
      const int mode = body.mode_numbers[static_cast<std::size_t>(k)] - 1;
      shapes_.block<2, 1>(2 * node, k) = superelement.shapes.block<2, 1>(3 * node, mode);
    }
  }
  displacement_ = Eigen::VectorXd::Zero(2 * num_nodes);
  if (body.stiffening || !superelement.geometric_stiffness) return;
  geometric_ = make_geometric(body, *superelement.geometric_stiffness, loads);
  present_ = Eigen::VectorXd::Zero(geometric_.rows());
  half_ = Eigen::VectorXd::Zero(std::lround(std::sqrt(static_cast<double>(geometric_.rows()))));
  stiffness_ = body.stiffness.diagonal().head(half_.size());
  if (half_.size() > 0) averaging_time_ = 2.0 / std::sqrt(stiffness_[0] / body.modal_mass[0]);
  now_ = Eigen::VectorXd::Zero(1 + 3 * half_.size());
}

void BodyBending::add(double time, const BodyLoads& loads, const Eigen::VectorXd& q) {
  const auto eta = q.segment(first_, num_modes_);
  support::multiply(shapes_, eta.data(), displacement_.data());
  double largest = 0.0;  // squared
  for (Eigen::Index node = 0; node < displacement_.size(); node += 2)
    largest = std::max(largest, displacement_.segment<2>(node).squaredNorm());
  if (largest > kBeyondRounding * deflection_.value * deflection_.value)
    deflection_ = {std::sqrt(largest), time};
  const Eigen::Index m = half_.size();
  if (m == 0) return;
  support::multiply(geometric_, loads.coefficients().data(), present_.data());
  const Eigen::Map<const Eigen::MatrixXd> K_G(present_.data(), m, m);
  half_.noalias() = K_G * eta.head(m);
  const auto squares = eta.head(m).array().square();
  now_[0] = eta.head(m).dot(half_);
  now_.segment(1, m) = stiffness_.array() * squares;
  now_.segment(1 + m, m) = K_G.diagonal().array().abs() / stiffness_.array();
  now_.tail(m) = K_G.diagonal().array().abs() * squares;
  add_to_means(time);
}

void BodyBending::add_to_means(double time) {
  if (averaged_.size() == 0) {
    once_ = averaged_ = now_;
  } else {
    const double share = -std::expm1((time_ - time) / averaging_time_);
    once_ += share * (now_ - once_);
    averaged_ += share * (once_ - averaged_);
  }
  time_ = time;
  const Eigen::Index m = half_.size();
  const auto affected = averaged_.segment(1 + m, m);
  const double least = kUnaffected * find_middle(affected, averaged_.tail(m));
  const double strain = (affected.array() >= least).select(averaged_.segment(1, m), 0.0).sum();
  largest_work_ = std::max(largest_work_, std::abs(averaged_[0]));
  largest_strain_ = std::max(largest_strain_, strain);
}

double BodyBending::axial_effect() const {
  return deflection_share() > kNoDeflection && largest_strain_ > 0.0 ? largest_work_ / largest_strain_ : 0.0;
}

}  // namespace sprung::dynamics

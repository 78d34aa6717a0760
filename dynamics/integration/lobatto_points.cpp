#include "dynamics/integration/lobatto_points.h"

#include <Eigen/LU>
#include <cmath>

namespace sprung::dynamics {

namespace {

using lobatto::kNumNodes;

const std::array<double, kNumNodes> kNode = {0.0, 0.5 - std::sqrt(0.05), 0.5 + std::sqrt(0.05), 1.0};

// Row k: coefficient of θ^k from the values at the nodes.
Eigen::Matrix4d make_coefficients() {
  Eigen::Matrix4d powers;
  for (int j = 0; j < kNumNodes; ++j) {
    double power = 1.0;
    for (int k = 0; k < kNumNodes; ++k) {
      powers(j, k) = power;
      power *= lobatto::node(j);
    }
  }
  return powers.inverse();
}

}  // namespace

const Eigen::Matrix4d& lobatto::power_coefficients() {
  static const Eigen::Matrix4d matrix = make_coefficients();
  return matrix;
}

const std::array<double, kNumNodes>& lobatto::nodes() {
  return kNode;
}

lobatto::NodeWeights lobatto::cubic_weights(double theta) {
  return power_coefficients().transpose() * Eigen::Vector4d(1.0, theta, theta * theta, theta * theta * theta);
}

double lobatto::node_polynomial(double theta) {
  double product = 1.0;
  for (const double c : kNode) product *= theta - c;
  return product;
}

lobatto::NodeWeights lobatto::third_degree_weights() {
  return power_coefficients().row(3).transpose();
}

}  // namespace sprung::dynamics

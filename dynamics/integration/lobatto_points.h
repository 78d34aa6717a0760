#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace sprung::dynamics {

/// The four Lobatto points of a step, from 0 at its start to 1 at its end, and interpolation through them.
namespace lobatto {

constexpr int kNumNodes = 4;
using NodeWeights = Eigen::Vector4d;
using NodeValues = Eigen::Matrix<double, Eigen::Dynamic, kNumNodes>;  ///< a column for each node

const std::array<double, kNumNodes>& nodes();
inline double node(int j) {
  return nodes()[static_cast<std::size_t>(j)];
}
/// Weights of the values at the nodes for the value of the cubic through them at θ.
NodeWeights cubic_weights(double theta);
/// (θ − c₀)(θ − c₁)(θ − c₂)(θ − c₃): what a quartic has beyond its cubic.
double node_polynomial(double theta);
/// Coefficients of node_polynomial by powers of θ.
inline constexpr std::array<double, kNumNodes + 1> kNodePolynomial = {0.0, -0.2, 1.2, -2.0, 1.0};
/// Row k holds the weights of the values at the nodes for the coefficient of θ^k of the cubic through them.
const Eigen::Matrix4d& power_coefficients();
/// Weights for the coefficient of θ³.
NodeWeights third_degree_weights();

/// out = Σ_j weight_j values_j, without a temporary.
template <class Out>
void combine(const NodeValues& values, const NodeWeights& weights, Out&& out) {
  out = weights[0] * values.col(0) + weights[1] * values.col(1) + weights[2] * values.col(2) +
        weights[3] * values.col(3);
}

}  // namespace lobatto

}  // namespace sprung::dynamics

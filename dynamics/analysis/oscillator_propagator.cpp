#include "dynamics/analysis/oscillator_propagator.h"

#include <Eigen/LU>
#include <cmath>

#include "dynamics/analysis/oscillator_response.h"

namespace sprung::dynamics {

namespace {

using lobatto::kNumNodes;

const std::array<double, kNumNodes> kNode = {0.0, 0.5 - std::sqrt(0.05), 0.5 + std::sqrt(0.05), 1.0};
// (θ − c₀)…(θ − c₃) by powers of θ.
constexpr std::array<double, kNumNodes + 1> kNodePolynomial = {0.0, -0.2, 1.2, -2.0, 1.0};
static_assert(OscillatorResponse::kMaxPower == kNumNodes);

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

const Eigen::Matrix4d& coefficients() {
  static const Eigen::Matrix4d matrix = make_coefficients();
  return matrix;
}

}  // namespace

double lobatto::node(int j) {
  return kNode[static_cast<std::size_t>(j)];
}

lobatto::NodeWeights lobatto::cubic_weights(double theta) {
  return coefficients().transpose() * Eigen::Vector4d(1.0, theta, theta * theta, theta * theta * theta);
}

double lobatto::node_polynomial(double theta) {
  double product = 1.0;
  for (const double c : kNode) product *= theta - c;
  return product;
}

lobatto::NodeWeights lobatto::third_degree_weights() {
  return coefficients().row(3).transpose();
}

void OscillatorPropagator::update(double theta, double length, const Eigen::ArrayXd& stiffness,
                                  const Eigen::ArrayXd& decay) {
  const Eigen::Index f = stiffness.size();
  if (c.size() != f) {
    c = s = c_rate = s_rate = quartic = quartic_rate = Eigen::ArrayXd::Zero(f);
    force = force_rate = lobatto::NodeValues::Zero(f, kNumNodes);
  }
  const Eigen::Matrix4d& C = coefficients();
  // θ^k = k!/h^k · t^k/k!, and the responses are those to t^k/k!.
  std::array<double, kNumNodes + 1> scale;
  scale[0] = 1.0;
  for (std::size_t k = 1; k <= kNumNodes; ++k) scale[k] = scale[k - 1] * static_cast<double>(k) / length;
  for (Eigen::Index m = 0; m < f; ++m) {
    const OscillatorResponse r = calc_oscillator_response(stiffness[m], decay[m], theta * length);
    c[m] = r.c;
    s[m] = r.s;
    c_rate[m] = r.c_rate;
    s_rate[m] = r.s_rate;
    Eigen::Vector4d cubic, cubic_rate;
    quartic[m] = quartic_rate[m] = 0.0;
    for (int k = 0; k <= kNumNodes; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double x = scale[i] * r.forced[i], x_rate = scale[i] * r.forced_rate(k);
      quartic[m] += kNodePolynomial[i] * x;
      quartic_rate[m] += kNodePolynomial[i] * x_rate;
      if (k == kNumNodes) break;
      cubic[k] = x;
      cubic_rate[k] = x_rate;
    }
    force.row(m) = cubic.transpose() * C;
    force_rate.row(m) = cubic_rate.transpose() * C;
  }
  Eigen::Vector4d powers;  // ∫ θ^k
  double power = theta;
  integral_quartic = 0.0;
  for (int k = 0; k <= kNumNodes; ++k) {
    const double value = length * power / (k + 1);
    integral_quartic += kNodePolynomial[static_cast<std::size_t>(k)] * value;
    if (k < kNumNodes) powers[k] = value;
    power *= theta;
  }
  for (int j = 0; j < kNumNodes; ++j) integral[static_cast<std::size_t>(j)] = C.col(j).dot(powers);
}

}  // namespace sprung::dynamics

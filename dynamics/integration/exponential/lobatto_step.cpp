#include "dynamics/integration/exponential/lobatto_step.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

using lobatto::kNumNodes;

static_assert(OscillatorResponse::kMaxPower == kNumNodes);

}  // namespace

LobattoPropagator::LobattoPropagator(Eigen::Index num_pairs)
    : determinant_(static_cast<std::size_t>(num_pairs)),
      decay_(static_cast<std::size_t>(num_pairs)),
      responses_(static_cast<std::size_t>(num_pairs)) {
  alpha_start_ = beta_start_ = alpha_quartic_ = beta_quartic_ = Eigen::ArrayXd::Zero(num_pairs);
  alpha_.fill(alpha_start_);
  beta_.fill(alpha_start_);
}

void LobattoPropagator::update(double theta, double length, const PairBlocks& blocks) {
  const Eigen::Index f = blocks.size();
  const Eigen::Matrix4d& C = lobatto::power_coefficients();
  // θ^k = k!/h^k · t^k/k!, and the responses are those to t^k/k!.
  std::array<double, kNumNodes + 1> scale;
  scale[0] = 1.0;
  for (std::size_t k = 1; k <= kNumNodes; ++k) scale[k] = scale[k - 1] * static_cast<double>(k) / length;
  // e^{Bt} = c I + s B, where c and s belong to the oscillator of the same trace and determinant, and its
  // integrals.
  for (Eigen::Index m = 0; m < f; ++m) {
    determinant_[static_cast<std::size_t>(m)] = blocks.determinant(m);
    decay_[static_cast<std::size_t>(m)] = -0.5 * blocks.trace(m);
  }
  calc_oscillator_responses(determinant_, decay_, theta * length, kNumNodes, responses_);
  for (Eigen::Index m = 0; m < f; ++m) {
    const OscillatorResponse& r = responses_[static_cast<std::size_t>(m)];
    const double two_d = -blocks.trace(m);
    alpha_start_[m] = r.c;
    beta_start_[m] = r.s;
    Eigen::Vector4d alpha, beta;
    alpha_quartic_[m] = beta_quartic_[m] = 0.0;
    for (int k = 0; k <= kNumNodes; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double a = scale[i] * (r.forced_rate(k) + two_d * r.forced[i]), b = scale[i] * r.forced[i];
      alpha_quartic_[m] += lobatto::kNodePolynomial[i] * a;
      beta_quartic_[m] += lobatto::kNodePolynomial[i] * b;
      if (k == kNumNodes) break;
      alpha[k] = a;
      beta[k] = b;
    }
    for (int j = 0; j < kNumNodes; ++j) {
      alpha_[static_cast<std::size_t>(j)][m] = C.col(j).dot(alpha);
      beta_[static_cast<std::size_t>(j)][m] = C.col(j).dot(beta);
    }
  }
  Eigen::Vector4d powers;  // ∫ θ^k
  double power = theta;
  integral_quartic_ = 0.0;
  for (int k = 0; k <= kNumNodes; ++k) {
    const double value = length * power / (k + 1);
    integral_quartic_ += lobatto::kNodePolynomial[static_cast<std::size_t>(k)] * value;
    if (k < kNumNodes) powers[k] = value;
    power *= theta;
  }
  for (int j = 0; j < kNumNodes; ++j) integral_[static_cast<std::size_t>(j)] = C.col(j).dot(powers);
}

void LobattoPropagator::apply(const PairBlocks& blocks, const Eigen::VectorXd& start,
                              const lobatto::NodeValues& drive, Eigen::VectorXd& u) const {
  const Eigen::Index f = blocks.size();
  for (Eigen::Index m = 0; m < f; ++m) {
    double plain1 = alpha_start_[m] * start[m], plain2 = alpha_start_[m] * start[f + m];
    double by_block1 = beta_start_[m] * start[m], by_block2 = beta_start_[m] * start[f + m];
    for (int j = 0; j < kNumNodes; ++j) {
      const double a = alpha_[static_cast<std::size_t>(j)][m], b = beta_[static_cast<std::size_t>(j)][m];
      plain1 += a * drive(m, j);
      plain2 += a * drive(f + m, j);
      by_block1 += b * drive(m, j);
      by_block2 += b * drive(f + m, j);
    }
    u[m] = plain1 + blocks.b11[m] * by_block1 + blocks.b12[m] * by_block2;
    u[f + m] = plain2 + blocks.b21[m] * by_block1 + blocks.b22[m] * by_block2;
  }
}

void LobattoPropagator::add_quartic(const PairBlocks& blocks, const Eigen::VectorXd& coefficients,
                                    Eigen::VectorXd& u) const {
  const Eigen::Index f = blocks.size();
  for (Eigen::Index m = 0; m < f; ++m) {
    const double g1 = coefficients[m], g2 = coefficients[f + m];
    const double a = alpha_quartic_[m], b = beta_quartic_[m];
    u[m] += a * g1 + b * (blocks.b11[m] * g1 + blocks.b12[m] * g2);
    u[f + m] += a * g2 + b * (blocks.b21[m] * g1 + blocks.b22[m] * g2);
  }
}

void LobattoPropagator::carry_error(const PairBlocks& blocks, double share,
                                    const Eigen::VectorXd& coefficients, Eigen::VectorXd& u) const {
  const Eigen::Index f = blocks.size();
  for (Eigen::Index m = 0; m < f; ++m) {
    const double trace = blocks.trace(m), determinant = blocks.determinant(m);
    if (!(4.0 * determinant > trace * trace)) {  // it does not vibrate
      u[m] = u[f + m] = 0.0;
      continue;
    }
    // The length of a pair changes by √det e^{Bt}, half of that time by the square root of it.
    const double a = alpha_start_[m], b = beta_start_[m];
    const double change = std::sqrt(std::max(0.0, a * (a + b * trace) + b * b * determinant));
    const double keep = 1.0 / std::max(1.0, change), add = share * std::min(1.0, std::sqrt(change));
    double constant = 0.0, by_block = 0.0;
    for (std::size_t j = 0; j < kNumNodes; ++j) {
      constant += alpha_[j][m];
      by_block += beta_[j][m];
    }
    const double u1 = u[m], u2 = u[f + m], g1 = coefficients[m], g2 = coefficients[f + m];
    const double plain1 = keep * a * u1 + add * constant * g1, plain2 = keep * a * u2 + add * constant * g2;
    const double by_block1 = keep * b * u1 + add * by_block * g1,
                 by_block2 = keep * b * u2 + add * by_block * g2;
    u[m] = plain1 + blocks.b11[m] * by_block1 + blocks.b12[m] * by_block2;
    u[f + m] = plain2 + blocks.b21[m] * by_block1 + blocks.b22[m] * by_block2;
  }
}

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dynamics/functions/oscillator_response.h"
#include "dynamics/integration/exponential/vibration_basis.h"
#include "dynamics/integration/lobatto_points.h"

namespace sprung::dynamics {

/// The exact solution of pairs, and the integrals of quadratures, from the start of a step up to one instant
/// of it, for a drive that is the cubic through its values at the Lobatto points
/// (integration/exponential, eq. 4). f pairs.
class LobattoPropagator {
 public:
  LobattoPropagator() = default;
  explicit LobattoPropagator(Eigen::Index num_pairs);

  /// @param theta  the instant, 0 to 1
  /// @param length  of the step [s]
  /// @param blocks  as many as when it was made
  void update(double theta, double length, const PairBlocks& blocks);

  /// u ← e^{Bt} u₀ + the response to the drive. @param start, u  2f @param drive  2f×4
  void apply(const PairBlocks& blocks, const Eigen::VectorXd& start, const lobatto::NodeValues& drive,
             Eigen::VectorXd& u) const;
  /// u += the response to a drive of node_polynomial(θ) times `coefficients`, 2f.
  void add_quartic(const PairBlocks& blocks, const Eigen::VectorXd& coefficients, Eigen::VectorXd& u) const;

  /// Carries an error of the pairs that vibrate on, without growth, and adds what a constant error of the
  /// drive, of `share` times `coefficients`, leaves by the end (integration/exponential, eq. 8). Other pairs
  /// have none. @param[in,out] u  2f
  void carry_error(const PairBlocks& blocks, double share, const Eigen::VectorXd& coefficients,
                   Eigen::VectorXd& u) const;

  double integral_weight(int j) const {
    return integral_[static_cast<std::size_t>(j)];
  }                                                              ///< of the rate at a node [s]
  double integral_quartic() const { return integral_quartic_; }  ///< [s]

 private:
  // Each function of B is α I + β B, by Cayley and Hamilton; f.
  Eigen::ArrayXd alpha_start_, beta_start_, alpha_quartic_, beta_quartic_;
  std::array<Eigen::ArrayXd, lobatto::kNumNodes> alpha_, beta_;
  std::array<double, lobatto::kNumNodes> integral_{};
  double integral_quartic_ = 0.0;
  std::vector<double> determinant_, decay_;  // of the oscillator that belongs to each pair
  std::vector<OscillatorResponse> responses_;
};

}  // namespace sprung::dynamics

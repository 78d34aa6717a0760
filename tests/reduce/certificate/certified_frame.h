#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "reduce/basis/basis.h"
#include "reduce/reduction/body_basis.h"
#include "tests/reduce/free_body_truth.h"

namespace sprung::reduce::testing {

/// A random frame with the residual of its interface loads in a basis of its free modes below 1.5 times the
/// band's end and some residual vectors.
struct CertifiedFrame {
  CertifiedFrame(std::uint64_t seed, int num_residual)
      : design(make_random_design(seed, 0.01)), truth(design.model), matrices(make_body_matrices(design)) {
    const double highest_hz = *design.reduction.highest_hz;
    modes = calc_modes_below(matrices.free, kBandMargin * highest_hz);
    highest = std::pow(2.0 * std::numbers::pi * highest_hz, 2);
    cutoff = modes.next_omega_squared;
    factor = std::make_unique<StiffnessFactor>(matrices.free.stiffness);
    const auto num_nodes = static_cast<int>(matrices.node_positions.cols());
    loads = balance_loads(matrices.rigid, make_interface_loads(num_nodes, design.reduction.interface));
    residual = std::make_unique<InterfaceResidual>(matrices.free, *factor, modes.pairs, loads);
    for (int i = 0; i < num_residual; ++i) residual->add(residual->make_vector(i % loads.cols(), highest));
  }

  /// What the basis misses of each load's own flexibility: that of the full model less that of the basis.
  Eigen::VectorXcd calc_true_errors(double s, double loss_factor = 0.0) const {
    const std::complex<double> stiffness(1.0, loss_factor);
    Eigen::VectorXcd errors = truth.calc_flexibility(s, design.reduction.interface, loss_factor).diagonal();
    for (const EigenPairs& pairs : {modes.pairs, residual->ritz()}) {
      for (Eigen::Index i = 0; i < pairs.omega_squared.size(); ++i) {
        const Eigen::VectorXd share = (pairs.vectors.col(i).transpose() * loads).cwiseAbs2();
        errors -= share / (stiffness * pairs.omega_squared(i) - s);
      }
    }
    return errors;
  }

  CertificateRequest make_request() const {
    return {.interface = design.reduction.interface,
            .frame_loads = make_frame_loads(design, matrices.rigid),
            .highest_hz = *design.reduction.highest_hz,
            .free_modes = modes.pairs,
            .next_omega_squared = modes.next_omega_squared,
            .holds_free_modes = true};
  }

  Design design;
  FreeBodyTruth truth;
  BodyMatrices matrices;
  ModesBelow modes;
  double highest = 0.0, cutoff = 0.0;  ///< ω² [rad²/s²]
  Eigen::MatrixXd loads;
  std::unique_ptr<StiffnessFactor> factor;
  std::unique_ptr<InterfaceResidual> residual;
};

}  // namespace sprung::reduce::testing

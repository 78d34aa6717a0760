#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// The force that the motion of a model with some modes held leaves unbalanced on the modes of the full
/// model,
///
///     r = Q − M q̈ − φ_qᵀλ   in their rows                                 (adaptivity, eq. 1)
///       = Σ (Φᵀ Aᵀ F + ψᵀ T) + PᵀAᵀ(g − R̈) − (c + ηᵀB)ᵀ θ̈ + θ̇² (d + M_tt η) + 2 θ̇ B η̇
///         − M_ff η̈ − C η̇ − K η,
///
/// summed over the markers. Of all terms of the full model only these rows are needed. No allocation.
class UnbalancedForce {
 public:
  /// @param full  has to outlive this
  explicit UnbalancedForce(const Model& full);

  /// @param run     terms of the model that is run, forces and Jacobian up to date; its markers, joints and
  ///                forces are those of the full model
  /// @param lambda  multipliers there
  /// @param q, v, v_dot  in coordinates of the full model, held ones at rest
  void update(const SystemTerms& run, const Eigen::VectorXd& lambda, const Eigen::VectorXd& q,
              const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);
  /// r at modal coordinates of the full model; the other rows are of no meaning.
  const Eigen::VectorXd& force() const { return force_; }

 private:
  // A body with modes. Its coefficients are Aᵀ(g − R̈), θ̈, θ̇², then AᵀF and T of each marker.
  struct FlexibleBody {
    std::size_t body;
    std::vector<std::size_t> markers;  // at which something acts
    Eigen::MatrixXd by_coefficient;    // n × coefficients
    Eigen::VectorXd coefficients;
  };

  const Model* full_;
  std::vector<FlexibleBody> bodies_;
  std::vector<Wrench> loads_;  // of each marker
  Eigen::VectorXd force_;
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <span>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// All unknowns of the constrained equations at an instant, each by itself. nq coordinates, m constraints.
struct ConstrainedMotion {
  explicit ConstrainedMotion(const Model& model)
      : q(Eigen::VectorXd::Zero(model.num_coordinates)),
        v(q),
        v_dot(q),
        lambda(Eigen::VectorXd::Zero(model.num_constraints)) {}

  double time = 0.0;            ///< [s]
  Eigen::VectorXd q, v, v_dot;  ///< nq
  Eigen::VectorXd lambda;       ///< m
};

/// Residual of the equations of motion and of the constraints on the level of positions, at any motion,
/// consistent or not:
///
///     r = M(q) v̇ + φ_qᵀλ − Q(q, v, t),   φ(q, t)                                      (system, eq. 9)
class Index3Residual {
 public:
  explicit Index3Residual(const Model& model);

  /// Allocates nothing.
  void update(const ConstrainedMotion& motion, std::span<const int> branches);
  const Eigen::VectorXd& force() const { return force_; }  ///< r, nq [N, N·m]
  const Eigen::VectorXd& phi() const { return phi_; }      ///< m [m, rad]

  const SystemTerms& terms() const { return terms_; }
  SystemTerms& terms() { return terms_; }
  long num_updates() const { return num_updates_; }

 private:
  SystemTerms terms_;
  Eigen::VectorXd force_, phi_;
  long num_updates_ = 0;
};

}  // namespace sprung::dynamics

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <span>
#include <vector>

#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/forces/spring_damper.h"
#include "dynamics/system/model.h"

namespace sprung::test {

/// A second, plain evaluator of the equations of motion, against which the fast one is tested and timed:
/// dense M q̈ + φ_qᵀλ = Q, φ_q q̈ = γ as one system of nq + m unknowns, solved by one LU with partial pivoting.
///
/// Of the library it uses the model's data alone. Mass and quadratic velocity terms come from the kinetic
/// energy in the world frame: with M(q) and its derivatives by each coordinate, Q_v = −Ṁv + ½ ∂(vᵀMv)/∂q.
/// Storage is allocated once. Knows revolute joints, spring-dampers and point-contact tyres. Source: [Shabana
/// 2013], §§3.5, 5.3 (Lagrange's equations with multipliers)
class DenseEvaluator {
 public:
  /// @throws std::invalid_argument for a kind of joint or force that it does not know
  explicit DenseEvaluator(const dynamics::Model& model);

  /// Newton for the dependent coordinates from where q has them; dependent as many as constraints.
  /// @param[in,out] q  nq
  /// @return false if |φ| does not come below 1e-12 of the model's length scale
  bool solve_positions(std::span<const int> dependent, Eigen::VectorXd& q);
  /// Dependent velocities so that φ_q v = 0. @param[in,out] v  nq
  void solve_velocities(std::span<const int> dependent, const Eigen::VectorXd& q, Eigen::VectorXd& v);
  /// Accelerations and multipliers at a state that satisfies the constraints.
  void solve_accelerations(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  const Eigen::VectorXd& v_dot() const { return v_dot_; }         ///< nq
  const Eigen::VectorXd& multipliers() const { return lambda_; }  ///< m
  double kinetic_energy() const { return kinetic_energy_; }       ///< at the state of solve_accelerations [J]

 private:
  struct BodyTerms {
    Eigen::MatrixXd M;                // (3+n)×(3+n)
    std::vector<Eigen::MatrixXd> dM;  // ∂M/∂θ, ∂M/∂η_1 … ∂M/∂η_n
    Eigen::VectorXd momentum, product, q, v;
    Eigen::Vector2d p, p_theta;
  };
  struct Point {
    Eigen::MatrixXd J;  // ∂r/∂q, 2×(3+n)
    Eigen::Vector2d r, v, bias;
    int first = -1;  // coordinate, −1 on the ground
  };

  void update_points(const Eigen::VectorXd& q);
  void update_point_velocities(const Eigen::VectorXd& v);
  void update_constraints();
  void calc_body(std::size_t body);
  void add_body(std::size_t body);
  void push(int marker, const Eigen::Vector2d& force);
  void add_spring_damper(const dynamics::SpringDamper::Parameters& parameters);
  void add_tyre(const dynamics::PointContactTyre& tyre);
  const Point& point(int marker) const { return points_[static_cast<std::size_t>(marker)]; }

  const dynamics::Model* model_;
  std::vector<const dynamics::SpringDamper*> springs_;
  std::vector<const dynamics::PointContactTyre*> tyres_;
  std::vector<BodyTerms> bodies_;
  std::vector<Point> points_;
  Eigen::MatrixXd Phi_q_, Phi_d_, augmented_;
  Eigen::VectorXd phi_, gamma_, Q_, right_side_, solution_, correction_, v_dot_, lambda_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_, lu_d_;
  double kinetic_energy_ = 0.0;
};

}  // namespace sprung::test

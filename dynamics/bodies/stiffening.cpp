#include "dynamics/bodies/stiffening.h"

#include <Eigen/LU>

#include "dynamics/bodies/body_equations.h"

namespace sprung::dynamics {

BodyStiffening make_body_stiffening(const reduce::Superelement& superelement,
                                    const std::vector<int>& columns) {
  const reduce::GeometricStiffness& geometric = *superelement.geometric_stiffness;
  const reduce::InertiaInvariants& inertia = superelement.inertia;
  const Eigen::Vector2d moment = inertia.first_moment;
  Eigen::Matrix3d rigid;
  rigid << inertia.mass, 0.0, -moment.y(),  //
      0.0, inertia.mass, moment.x(),        //
      -moment.y(), moment.x(), inertia.second_moment;
  const Eigen::Matrix3d inverse = rigid.inverse();
  const SecondOrder inertial{geometric.acceleration[0](columns, columns),
                             geometric.acceleration[1](columns, columns),
                             geometric.angular_acceleration(columns, columns)};
  BodyStiffening stiffening;
  for (Eigen::Index c = 0; c < 3; ++c) {
    stiffening.origin[static_cast<std::size_t>(c)] =
        inverse(c, 0) * inertial[0] + inverse(c, 1) * inertial[1] + inverse(c, 2) * inertial[2];
  }
  stiffening.centrifugal = geometric.centrifugal(columns, columns) + moment.x() * stiffening.origin[0] +
                           moment.y() * stiffening.origin[1];
  const Eigen::RowVectorXd about_origin = inertia.c(columns);
  const Eigen::Matrix2Xd P = inertia.P(Eigen::all, columns);
  stiffening.mean_rotation = (about_origin - turned(moment).transpose() * P / inertia.mass) /
                             (inertia.second_moment - moment.squaredNorm() / inertia.mass);
  return stiffening;
}

SecondOrder calc_second_order(const reduce::Superelement& superelement, const std::vector<int>& columns,
                              const BodyStiffening& stiffening, int point, const Eigen::Vector2d& offset) {
  const int node = superelement.points[static_cast<std::size_t>(point)].node;
  SecondOrder K = superelement.geometric_stiffness->point_loads[static_cast<std::size_t>(point)];
  for (Eigen::MatrixXd& matrix : K) matrix = matrix(columns, columns).eval();
  // Relative to the frame that gets no momentum from it (bodies, eq. 9), then by the offset, which turns
  // (bodies, eq. 10).
  K[2] += stiffening.origin[2];
  const Eigen::Vector2d across = turned(superelement.node_positions.col(node));
  const Eigen::Vector2d across_offset = turned(offset);
  const Eigen::RowVectorXd psi = superelement.shapes(3 * node + 2, columns);
  for (Eigen::Index c = 0; c < 2; ++c) {
    K[static_cast<std::size_t>(c)] += stiffening.origin[static_cast<std::size_t>(c)] +
                                      across[c] * stiffening.origin[2] + across_offset[c] * K[2] +
                                      offset[c] * psi.transpose() * psi;
  }
  return K;
}

Eigen::Vector3d calc_half_form(const SecondOrder& K, const Eigen::Ref<const Eigen::VectorXd>& eta) {
  Eigen::Vector3d form = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < eta.size(); ++k) {
    for (Eigen::Index c = 0; c < 3; ++c)
      form[c] += 0.5 * eta[k] * K[static_cast<std::size_t>(c)].col(k).dot(eta);
  }
  return form;
}

void add_stiffening_forces(const BodyStiffening& stiffening, double theta_dot,
                           const Eigen::Ref<const Eigen::VectorXd>& eta,
                           const Eigen::Ref<const Eigen::VectorXd>& eta_dot, Eigen::Ref<Eigen::VectorXd> Q) {
  const Eigen::Index n = eta.size();
  const double omega = theta_dot + stiffening.mean_rotation.dot(eta_dot);
  double power = 0.0;  // ηᵀ K_ω η̇
  for (Eigen::Index k = 0; k < n; ++k) {
    const double K_eta = stiffening.centrifugal.col(k).dot(eta);
    Q[3 + k] -= omega * omega * K_eta;
    power += K_eta * eta_dot[k];
  }
  Q[2] += omega * power;
  for (Eigen::Index k = 0; k < n; ++k) Q[3 + k] += omega * power * stiffening.mean_rotation[k];
}

}  // namespace sprung::dynamics

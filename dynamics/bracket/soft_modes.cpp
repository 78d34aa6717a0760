#include "dynamics/bracket/soft_modes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/support/dense/join_columns.h"

namespace sprung::dynamics {

namespace {

// The matrix with `side` to its right, ± its transpose below and `corner` in the corner.
Eigen::MatrixXd border(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& side, double sign,
                       const Eigen::MatrixXd& corner) {
  const Eigen::Index n = matrix.rows(), q = corner.rows();
  Eigen::MatrixXd bordered(n + q, n + q);
  bordered << matrix, side, sign * side.transpose(), corner;
  return bordered;
}

// M_r = ∫RᵀR dm of the undeformed body about its frame's origin.
Eigen::Matrix3d make_rigid_mass(const Body& body) {
  const double m = body.mass, x = body.first_moment.x(), y = body.first_moment.y();
  Eigen::Matrix3d mass;
  mass << m, 0.0, -y, 0.0, m, x, -y, x, body.second_moment;
  return mass;
}

// H = ∫RᵀΦ dm of the first n modes, 3×n.
Eigen::MatrixXd make_momenta(const Body& body, Eigen::Index n) {
  Eigen::MatrixXd momenta(3, n);
  momenta << body.P.leftCols(n), body.c.leftCols(n);
  return momenta;
}

}  // namespace

Eigen::MatrixXd calc_soft_shapes(const reduce::Superelement& superelement, Eigen::Index node) {
  const reduce::Certificate& certificate = *superelement.certificate;
  if (certificate.soft_reference.cols() == 3 && node == reduce::find_reference_node(superelement))
    return certificate.soft_reference.transpose();
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3, certificate.soft_loads.rows());
  for (std::size_t j = 0; j < certificate.interface.size(); ++j) {
    const reduce::InterfaceError& one = certificate.interface[j];
    if (superelement.points[static_cast<std::size_t>(one.point)].node == node)
      shapes.row(one.freedom) = certificate.soft_loads.col(static_cast<Eigen::Index>(j)).transpose();
  }
  return shapes;
}

SoftStiffness calc_soft_stiffness(const reduce::Certificate& certificate) {
  constexpr double kSmallestShare =
      1e-4;  // of what is missed at rest, itself a small share of the deflection
  const double cutoff = 2.0 * std::numbers::pi * certificate.cutoff_hz;
  const Eigen::VectorXd in_motion = Eigen::VectorXd::Constant(certificate.soft_loads.rows(), cutoff * cutoff);
  if (certificate.soft_static_share.size() == 0) return {.at_rest = in_motion, .in_motion = in_motion};
  return {.at_rest = in_motion.cwiseQuotient(certificate.soft_static_share.cwiseMax(kSmallestShare)),
          .in_motion = in_motion};
}

// In the body's frame a soft mode is V − RΘ, with Θ its motion of the reference node (reduce/basis, eq. 1). V
// has unit mass and no momentum. Of what deflection changes of the inertia, RΘ is known, and of V what a
// rotation of the undeformed body does, ∫(x V_x + y V_y) dm.
void add_soft_modes(Body& body, const reduce::Superelement& superelement) {
  const reduce::Certificate& certificate = *superelement.certificate;
  const Eigen::Index n = body.num_modes(), q = certificate.soft_loads.rows();
  const Eigen::RowVectorXd radial = certificate.soft_radial.size() == q
                                        ? Eigen::RowVectorXd(certificate.soft_radial.transpose())
                                        : Eigen::RowVectorXd::Zero(q);
  const Eigen::MatrixXd carried =
      -calc_soft_shapes(superelement, reduce::find_reference_node(superelement));  // −Θ, 3×q
  const double m = body.mass, x = body.first_moment.x(), y = body.first_moment.y();
  const Eigen::Matrix3d rigid = make_rigid_mass(body);
  Eigen::Matrix3d turned_rigid;  // ∫(R_xᵀR_y − R_yᵀR_x) dm
  turned_rigid << 0.0, m, x, -m, 0.0, y, -x, -y, 0.0;
  const Eigen::MatrixXd momenta = make_momenta(body, n);
  Eigen::MatrixXd turned_momenta(3, n);  // ∫(R_xᵀΦ_y − R_yᵀΦ_x) dm
  turned_momenta << body.P.row(1), -body.P.row(0), -body.d;
  const Eigen::RowVectorXd rotations = rigid.ldlt().solve(momenta).row(2);  // −Θ of the modes

  const Eigen::MatrixXd coupling = momenta.transpose() * carried, own = carried.transpose() * rigid * carried;
  body.M_ff = border(body.M_ff, coupling, 1.0, own + Eigen::MatrixXd::Identity(q, q));
  body.M_tt = border(body.M_tt, coupling, 1.0, own);
  const Eigen::MatrixXd of_rotations = carried.row(2).transpose() * radial;
  body.B = border(body.B, -turned_momenta.transpose() * carried - rotations.transpose() * radial, -1.0,
                  carried.transpose() * turned_rigid * carried - of_rotations + of_rotations.transpose());
  body.P = support::join_columns(body.P, rigid.topRows(2) * carried);
  body.c = support::join_columns(body.c, rigid.row(2) * carried).row(0);
  body.d = support::join_columns(body.d, body.first_moment.transpose() * carried.topRows(2) + radial).row(0);
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(n, q);
  body.stiffness =
      border(body.stiffness, nothing, 1.0, calc_soft_stiffness(certificate).at_rest.asDiagonal());
  body.damping = border(body.damping, nothing, 1.0, Eigen::MatrixXd::Zero(q, q));
  body.modal_mass.conservativeResize(n + q);
  body.modal_mass.tail(q).setOnes();
  body.mode_scale.conservativeResize(n + q);
  body.mode_scale.tail(q) =
      support::join_columns(certificate.soft_loads, carried.transpose()).cwiseAbs().rowwise().maxCoeff();
  for (int k = 1; k <= q; ++k) body.mode_numbers.push_back(superelement.num_modes() + k);
}

UnknownInertia calc_unknown_inertia(const Body& body, Eigen::Index num_modes, const SoftStiffness& stiffness,
                                    const Eigen::VectorXd& amplitudes) {
  const Eigen::VectorXd kept = amplitudes.head(num_modes),
                        soft = amplitudes.tail(amplitudes.size() - num_modes);
  const Eigen::MatrixXd momenta = make_momenta(body, num_modes);
  UnknownInertia unknown;
  unknown.elastic_mass = body.M_ff.topLeftCorner(num_modes, num_modes) -
                         momenta.transpose() * make_rigid_mass(body).ldlt().solve(momenta);
  unknown.known = std::sqrt(std::max(0.0, kept.dot(unknown.elastic_mass * kept)));
  unknown.missed = std::sqrt(soft.cwiseAbs2().dot(stiffness.at_rest.cwiseQuotient(stiffness.in_motion)));
  unknown.radius = std::sqrt(body.second_moment - body.first_moment.squaredNorm() / body.mass);
  return unknown;
}

}  // namespace sprung::dynamics

#include "reduce/export/spatial_integrals.h"

namespace sprung::reduce {

Eigen::Matrix3d make_cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

Eigen::Matrix3d calc_inertia_tensor(const InertiaInvariants& inertia) {
  const double J = inertia.second_moment;
  return Eigen::Vector3d(0.5 * J, 0.5 * J, J).asDiagonal();
}

Eigen::Matrix3d calc_linear_products(const InertiaInvariants& inertia, Eigen::Index k) {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  products.topLeftCorner<2, 2>() << inertia.y_phi_y(k), -inertia.y_phi_x(k),  //
      -inertia.x_phi_y(k), inertia.x_phi_x(k);
  products(2, 2) = inertia.d(k);
  return products;
}

Eigen::Matrix3d calc_quadratic_products(const InertiaInvariants& inertia, Eigen::Index i, Eigen::Index j) {
  const Eigen::MatrixXd &xx = inertia.phi_x_phi_x, &xy = inertia.phi_x_phi_y, &yy = inertia.phi_y_phi_y;
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  products.topLeftCorner<2, 2>() << yy(i, j), -xy(j, i),  //
      -xy(i, j), xx(i, j);
  products(2, 2) = xx(i, j) + yy(i, j);
  return products;
}

Eigen::VectorXd expand_positions(const Superelement& s) {
  Eigen::Matrix3Xd positions = Eigen::Matrix3Xd::Zero(3, s.num_nodes());
  positions.topRows(2) = s.node_positions;
  return positions.reshaped();
}

Eigen::MatrixXd expand_displacements(const Superelement& s) {
  Eigen::MatrixXd displacements = Eigen::MatrixXd::Zero(s.shapes.rows(), s.shapes.cols());
  for (Eigen::Index node = 0; node < s.num_nodes(); ++node)
    displacements.middleRows<2>(3 * node) = s.shapes.middleRows<2>(3 * node);
  return displacements;
}

Eigen::MatrixXd expand_rotations(const Superelement& s) {
  Eigen::MatrixXd rotations = Eigen::MatrixXd::Zero(s.shapes.rows(), s.shapes.cols());
  for (Eigen::Index node = 0; node < s.num_nodes(); ++node)
    rotations.row(3 * node + 2) = s.shapes.row(3 * node + 2);
  return rotations;
}

}  // namespace sprung::reduce

#include "reduce/modes/free_body.h"

#include <Eigen/Cholesky>

#include "reduce/modes/held_node.h"

namespace sprung::reduce {

RigidMotions calc_rigid_motions(const Eigen::Matrix2Xd& node_positions,
                                const Eigen::SparseMatrix<double>& mass, int reference_node) {
  RigidMotions rigid{.reference_node = reference_node,
                     .shapes = Eigen::MatrixXd::Zero(mass.rows(), 3),
                     .momenta = {},
                     .mass = {}};
  for (Eigen::Index node = 0; node < node_positions.cols(); ++node) {
    rigid.shapes.middleRows<3>(3 * node) << 1.0, 0.0, -node_positions(1, node),  //
        0.0, 1.0, node_positions(0, node),                                       //
        0.0, 0.0, 1.0;
  }
  rigid.momenta = mass * rigid.shapes;
  const Eigen::Matrix3d product = rigid.shapes.transpose() * rigid.momenta;
  rigid.mass = 0.5 * (product + product.transpose());
  return rigid;
}

Eigen::MatrixXd calc_rigid_share(const RigidMotions& rigid) {
  const Eigen::LLT<Eigen::Matrix3d> factor(rigid.mass);
  const Eigen::MatrixXd momenta = remove_node(rigid.momenta, rigid.reference_node);
  return factor.matrixL().solve(momenta.transpose()).transpose();
}

Eigen::MatrixXd balance_loads(const RigidMotions& rigid, const Eigen::MatrixXd& loads) {
  if (loads.cols() == 0) return Eigen::MatrixXd(loads.rows() - 3, 0);
  const Eigen::MatrixXd acceleration = rigid.mass.llt().solve(rigid.shapes.transpose() * loads);
  return remove_node(Eigen::MatrixXd(loads - rigid.momenta * acceleration), rigid.reference_node);
}

Eigen::MatrixXd remove_momentum(const RigidMotions& rigid, const Eigen::MatrixXd& shapes) {
  return shapes - rigid.shapes * rigid.mass.llt().solve(rigid.momenta.transpose() * shapes);
}

}  // namespace sprung::reduce

#include "tools/support/dense/orthogonal_factors.h"

#include <Eigen/QR>
#include <Eigen/SVD>

namespace sprung::support {

ColumnSpace find_column_space(const Eigen::MatrixXd& A, Eigen::Index num_columns) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  return {.basis = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), num_columns), .rank = qr.rank()};
}

Eigen::MatrixXd make_rotation_onto(const Eigen::VectorXd& direction) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(direction).householderQ();
}

Eigen::MatrixXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(A).solve(b);
}

Eigen::VectorXd solve_minimum_norm(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(A).solve(b);
}

Eigen::VectorXd calc_singular_values(const Eigen::MatrixXd& A) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(A).singularValues();
}

SingularPairs calc_left_singular_pairs(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU);
  return {svd.singularValues(), svd.matrixU()};
}

SingularPairs calc_right_singular_pairs(const Eigen::MatrixXd& A) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace sprung::support

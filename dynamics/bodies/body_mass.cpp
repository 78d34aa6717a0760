#include "dynamics/bodies/body_mass.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace sprung::dynamics {

namespace {

// Off-diagonal parts of M_ff below this share are the rounding of mass-normalised modes.
constexpr double kRounding = 1e-12;

bool is_diagonal(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (std::abs(matrix(i, j)) > kRounding * std::sqrt(matrix(i, i) * matrix(j, j))) return false;
    }
  }
  return true;
}

}  // namespace

BodyMass::BodyMass(const Body& body)
    : body_(&body),
      constant_(body.num_modes() == 0 && body.first_moment.isZero(0.0)),
      diagonal_(is_diagonal(body.M_ff)) {
  const Eigen::Index n = body.num_modes();
  diagonal_inverse_ = body.M_ff.diagonal().cwiseInverse();
  if (!diagonal_) M_ff_inverse_ = body.M_ff.llt().solve(Eigen::MatrixXd::Identity(n, n));
  M_ = Eigen::MatrixXd::Zero(3 + n, 3 + n);
  W_ = Eigen::Matrix3Xd::Zero(3, n);
  modal_work_ = Eigen::VectorXd::Zero(n);
  if (constant_) {
    M_.diagonal() << body.mass, body.mass, body.second_moment;
    C_inverse_ = M_.diagonal().cwiseInverse().asDiagonal();
  } else {
    C_inverse_.setZero();
  }
}

void BodyMass::update(const FrameRotation& rotation, const Eigen::Ref<const Eigen::VectorXd>& eta) {
  if (constant_) return;
  calc_mass_matrix(*body_, rotation, eta, M_);
  const Eigen::Index n = body_->num_modes();
  Eigen::Matrix3d C = M_.topLeftCorner<3, 3>();
  if (n > 0) {
    if (diagonal_) {
      for (Eigen::Index k = 0; k < n; ++k) W_.col(k) = M_.block<3, 1>(0, 3 + k) * diagonal_inverse_[k];
    } else {
      W_.noalias() = M_.topRightCorner(3, n).lazyProduct(M_ff_inverse_);
    }
    for (Eigen::Index k = 0; k < n; ++k) C.noalias() -= W_.col(k) * M_.block<1, 3>(3 + k, 0);
  }
  C_inverse_ = C.inverse();
}

void BodyMass::solve_coupled(double* x) const {
  const Eigen::Index n = body_->num_modes();
  Eigen::Map<Eigen::Vector3d> rigid(x);
  Eigen::Map<Eigen::VectorXd> modal(x + 3, n);
  Eigen::Vector3d y = rigid;
  for (Eigen::Index k = 0; k < n; ++k) y -= W_.col(k) * modal[k];
  rigid = C_inverse_ * y;
  if (n == 0) return;
  for (Eigen::Index k = 0; k < n; ++k) modal[k] -= M_.block<1, 3>(3 + k, 0).dot(rigid);
  if (diagonal_) {
    for (Eigen::Index k = 0; k < n; ++k) modal[k] *= diagonal_inverse_[k];
  } else {
    modal_work_ = modal;
    modal.noalias() = M_ff_inverse_.lazyProduct(modal_work_);
  }
}

void BodyMass::reduce_modal_part(const double* G_f, double* y, double* U, double* V) const {
  using EveryOther = Eigen::Map<Eigen::VectorXd, Eigen::Unaligned, Eigen::InnerStride<2>>;
  const Eigen::Index n = W_.cols();
  for (Eigen::Index k = 0; k < n; ++k) {
    for (int i = 0; i < 3; ++i) y[i] -= W_(i, k) * G_f[k];
    U[2 * k] = G_f[k];
  }
  if (diagonal_) {
    for (Eigen::Index k = 0; k < n; ++k) V[2 * k] = G_f[k] * diagonal_inverse_[k];
  } else {
    EveryOther(V, n).noalias() = M_ff_inverse_.lazyProduct(Eigen::Map<const Eigen::VectorXd>(G_f, n));
  }
}

}  // namespace sprung::dynamics

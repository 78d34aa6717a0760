#include "dynamics/bodies/body_mass.h"

#include <cmath>

#include "tools/support/dense/dense_solvers.h"

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
  if (!diagonal_)
    M_ff_inverse_ = support::solve_positive_definite(body.M_ff, Eigen::MatrixXd::Identity(n, n));
  M_ = Eigen::MatrixXd::Zero(3 + n, 3 + n);
  M_.bottomRightCorner(n, n) = body.M_ff;
  M_(0, 0) = M_(1, 1) = body.mass;
  W_ = Eigen::Matrix3Xd::Zero(3, n);
  modal_work_ = Eigen::VectorXd::Zero(n);
  if (constant_) {
    M_.diagonal() << body.mass, body.mass, body.second_moment;
    C_inverse_ = M_.diagonal().cwiseInverse().asDiagonal();
  } else {
    C_inverse_.setZero();
  }
}

// One number at a time: pairs whose halves have just been written one by one are slow to read.
void BodyMass::update(const FrameRotation& rotation, const Eigen::Ref<const Eigen::VectorXd>& eta) {
  if (constant_) return;
  update_mass_matrix(*body_, rotation, eta, M_);
  const Eigen::Index n = body_->num_modes();
  if (!diagonal_) W_.noalias() = M_.topRightCorner(3, n).lazyProduct(M_ff_inverse_);
  double xx = M_(0, 0), xy = M_(1, 0), yy = M_(1, 1), xt = M_(2, 0), yt = M_(2, 1), tt = M_(2, 2);  // C
  for (Eigen::Index k = 0; k < n; ++k) {
    const double* H = M_.col(3 + k).data();
    double* W = W_.col(k).data();
    if (diagonal_) {
      for (int i = 0; i < 3; ++i) W[i] = H[i] * diagonal_inverse_[k];
    }
    xx -= W[0] * H[0];
    xy -= W[1] * H[0];
    yy -= W[1] * H[1];
    xt -= W[2] * H[0];
    yt -= W[2] * H[1];
    tt -= W[2] * H[2];
  }
  const double of_xx = yy * tt - yt * yt, of_xy = xt * yt - xy * tt, of_xt = xy * yt - xt * yy;  // cofactors
  const double inverse = 1.0 / (xx * of_xx + xy * of_xy + xt * of_xt);
  C_inverse_(0, 0) = inverse * of_xx;
  C_inverse_(1, 1) = inverse * (xx * tt - xt * xt);
  C_inverse_(2, 2) = inverse * (xx * yy - xy * xy);
  C_inverse_(0, 1) = C_inverse_(1, 0) = inverse * of_xy;
  C_inverse_(0, 2) = C_inverse_(2, 0) = inverse * of_xt;
  C_inverse_(1, 2) = C_inverse_(2, 1) = inverse * (xy * xt - xx * yt);
}

void BodyMass::solve_coupled(double* x) const {
  const Eigen::Index n = body_->num_modes();
  double* modal = x + 3;
  double y[3] = {x[0], x[1], x[2]};
  const double* W = W_.data();
  for (Eigen::Index k = 0; k < n; ++k, W += 3) {
    for (int i = 0; i < 3; ++i) y[i] -= W[i] * modal[k];
  }
  for (int i = 0; i < 3; ++i)
    x[i] = C_inverse_(0, i) * y[0] + C_inverse_(1, i) * y[1] + C_inverse_(2, i) * y[2];
  for (Eigen::Index k = 0; k < n; ++k) {
    const double* H = M_.col(3 + k).data();
    modal[k] -= H[0] * x[0] + H[1] * x[1] + H[2] * x[2];
    if (diagonal_) modal[k] *= diagonal_inverse_[k];
  }
  if (diagonal_) return;
  modal_work_ = Eigen::Map<const Eigen::VectorXd>(modal, n);
  Eigen::Map<Eigen::VectorXd>(modal, n).noalias() = M_ff_inverse_.lazyProduct(modal_work_);
}

void BodyMass::reduce_modal_part(const double* upper, const double* lower, Eigen::Vector2d* U,
                                 Eigen::Vector2d* V) const {
  const Eigen::Index n = W_.cols();
  const double* W = W_.data();
  Eigen::Vector2d y[3] = {U[0], U[1], U[2]};
  for (Eigen::Index k = 0; k < n; ++k, W += 3) {
    const Eigen::Vector2d G_f(upper[k], lower[k]);
    for (int i = 0; i < 3; ++i) y[i] -= W[i] * G_f;
    U[3 + k] = G_f;
    V[3 + k] = diagonal_inverse_[k] * G_f;
  }
  for (int i = 0; i < 3; ++i) U[i] = y[i];
  if (diagonal_) return;
  Eigen::Map<Eigen::Matrix2Xd>(V[3].data(), 2, n).noalias() =
      Eigen::Map<const Eigen::Matrix2Xd>(U[3].data(), 2, n).lazyProduct(M_ff_inverse_);
}

}  // namespace sprung::dynamics

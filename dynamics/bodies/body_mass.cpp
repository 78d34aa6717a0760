#include "dynamics/bodies/body_mass.h"

#include <algorithm>
#include <cmath>

#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"

namespace sprung::dynamics {

namespace {

constexpr double kRounding = 1e-12;  // of eigenvalues of mass-normalised modes

// G of M_ff⁻¹ = I − G Gᵀ (bodies, eq. 13); without columns where M_ff is of another kind.
Eigen::MatrixXd factorise_inverse(const Eigen::MatrixXd& M_ff) {
  const Eigen::Index n = M_ff.rows();
  const auto pairs = support::solve_symmetric(M_ff - Eigen::MatrixXd::Identity(n, n));
  if (!pairs) return Eigen::MatrixXd(n, 0);
  const Eigen::VectorXd& values = pairs->values;  // ascending
  const double rounding = kRounding * std::max(1.0, values.cwiseAbs().maxCoeff());
  const Eigen::Index rank = (values.array() > rounding).count();
  if (rank > 3 || values.minCoeff() < -rounding) return Eigen::MatrixXd(n, 0);
  const Eigen::VectorXd shares = (values.tail(rank).array() / (1.0 + values.tail(rank).array())).sqrt();
  return pairs->vectors.rightCols(rank) * shares.asDiagonal();
}

}  // namespace

BodyMass::BodyMass(const Body& body)
    : body_(&body),
      constant_(body.num_modes() == 0 && body.first_moment.isZero(0.0)),
      stand_in_(body.stand_in_mass, body.stand_in_mass, body.stand_in_inertia),
      M_tt_(body.M_tt, body.M_tt.diagonal()),
      B_(body.B, body.M_tt.diagonal()),
      first_moment_(body.first_moment),
      M_tt_eta_(Eigen::VectorXd::Zero(body.num_modes())),
      B_eta_(M_tt_eta_),
      diagonal_(ModalMatrix(body.M_ff, body.M_ff.diagonal()).is_diagonal()) {
  const Eigen::Index n = body.num_modes();
  diagonal_inverse_ = body.M_ff.diagonal().cwiseInverse();
  if (!diagonal_) inverse_factor_ = factorise_inverse(body.M_ff);
  if (!diagonal_ && inverse_factor_.cols() == 0)
    M_ff_inverse_ = support::solve_positive_definite(body.M_ff, Eigen::MatrixXd::Identity(n, n));
  M_ = Eigen::MatrixXd::Zero(3 + n, 3 + n);
  M_.bottomRightCorner(n, n) = body.M_ff;
  M_(0, 0) = M_(1, 1) = body.mass;
  W_ = Eigen::Matrix3Xd::Zero(3, n);
  modal_work_ = Eigen::VectorXd::Zero(n);
  if (constant_) {
    M_.diagonal() << body.mass, body.mass, body.second_moment;
    C_inverse_ = (M_.diagonal() + stand_in_).cwiseInverse().asDiagonal();
  } else {
    C_inverse_.setZero();
  }
}

// rows ← rows M_ff⁻¹, where M_ff is not diagonal. @param rows  k×n
template <int num_rows>
void BodyMass::multiply_inverse(double* values) const {
  const Eigen::Index n = body_->num_modes();
  Eigen::Map<Eigen::Matrix<double, num_rows, Eigen::Dynamic>> rows(values, num_rows, n);
  if (inverse_factor_.cols() == 0) {
    for (int i = 0; i < num_rows; ++i) {
      modal_work_ = rows.row(i).transpose();
      rows.row(i).transpose().noalias() = M_ff_inverse_.lazyProduct(modal_work_);
    }
    return;
  }
  for (Eigen::Index j = 0; j < inverse_factor_.cols(); ++j) {
    const double* G = inverse_factor_.col(j).data();
    Eigen::Matrix<double, num_rows, 1> amount = Eigen::Matrix<double, num_rows, 1>::Zero();
    for (Eigen::Index k = 0; k < n; ++k) amount += G[k] * rows.col(k);
    for (Eigen::Index k = 0; k < n; ++k) rows.col(k) -= G[k] * amount;
  }
}

// The entries of M that depend on the state. B is skew, so ηᵀB = −(B η)ᵀ.
void BodyMass::update_matrix(const FrameRotation& rotation, const double* eta) {
  const Body& body = *body_;
  const Eigen::Index n = body.num_modes();
  M_tt_.multiply(eta, M_tt_eta_.data());
  B_.multiply(eta, B_eta_.data());
  first_moment_ = body.first_moment;
  double inertia = body.second_moment;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Vector2d P = body.P.col(k), in_world = rotation * P;
    M_(0, 3 + k) = M_(3 + k, 0) = in_world.x();
    M_(1, 3 + k) = M_(3 + k, 1) = in_world.y();
    M_(2, 3 + k) = M_(3 + k, 2) = body.c[k] - B_eta_[k];
    first_moment_ += eta[k] * P;
    inertia += (2.0 * body.d[k] + M_tt_eta_[k]) * eta[k];
  }
  const Eigen::Vector2d across = rotation * turned(first_moment_);
  M_(0, 2) = M_(2, 0) = across.x();
  M_(1, 2) = M_(2, 1) = across.y();
  M_(2, 2) = inertia;
}

// Scalars are read one at a time: a vector load of two scalars that have just been stored singly is slow.
void BodyMass::update(const FrameRotation& rotation, const Eigen::Ref<const Eigen::VectorXd>& eta) {
  if (constant_) return;
  update_matrix(rotation, eta.data());
  const Eigen::Index n = body_->num_modes();
  if (!diagonal_) {
    W_ = M_.topRightCorner(3, n);
    multiply_inverse<3>(W_.data());
  }
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
  multiply_inverse<1>(modal);
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
  for (Eigen::Index k = 0; k < n; ++k) V[3 + k] = U[3 + k];
  multiply_inverse<2>(V[3].data());
}

}  // namespace sprung::dynamics

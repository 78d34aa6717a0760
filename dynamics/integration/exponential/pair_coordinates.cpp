#include "dynamics/integration/exponential/pair_coordinates.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

PairCoordinates::PairCoordinates(Eigen::Index num_freedoms, Eigen::Index size)
    : f_(num_freedoms),
      origin_(Eigen::VectorXd::Zero(num_freedoms)),
      inverse_allowed_(Eigen::VectorXd::Zero(size)),
      work_(Eigen::VectorXd::Zero(size)),
      derivatives_(work_) {}

void PairCoordinates::update(const SmallMotion& motion, const std::vector<int>& elastic,
                             const Eigen::VectorXd& y) {
  basis_ = make_vibration_basis(motion);
  shear_.start(basis_, elastic, motion.mass);
  pair_sizes_ = (inverse_allowed_.head(2 * f_).asDiagonal() * basis_.T).colwise().norm().transpose();
  pair_sizes_ /= std::sqrt(static_cast<double>(y.size()));
  origin_ = y.head(f_);
  const PairBlocks& B = blocks();
  highest_frequency_ = std::sqrt(std::max(0.0, (B.b11 * B.b22 - B.b12 * B.b21).maxCoeff()));
}

bool PairCoordinates::aim_shear(const Eigen::MatrixXd* mass_columns, CollocationStep& now,
                                CollocationStep& last) {
  if (mass_columns != nullptr && shear_.calc_shear(*mass_columns, rate_)) {
    rate_ = (rate_ - now.shear.start()) / now.length;
  } else {
    rate_.setZero(now.shear.rate().rows(), now.shear.rate().cols());
  }
  rate_change_ = rate_ - now.shear.rate();
  if (rate_change_.isZero(0.0)) return false;
  now.shear.set_rate(rate_);
  shear_.change_rate(rate_change_, now.elastic, 0, 0.0, blocks(), now.drive.pairs);
  for (int j = 0; j < lobatto::kNumNodes; ++j) {
    const double time = last.start + lobatto::node(j) * last.length;
    shear_.change_rate(rate_change_, last.elastic, j, time - now.start, blocks(), last.drive.pairs);
  }
  return true;
}

void PairCoordinates::to_pairs(const Eigen::VectorXd& y, const CollocationStep& step, PairedMotion& motion) {
  work_ = y;
  work_.head(f_) -= origin_;
  shear_.remove(step.shear, 0.0, work_.data());
  basis_.to_pairs(work_.data(), motion.u.data());
  motion.w = y.tail(motion.w.size());
}

void PairCoordinates::to_state(const PairedMotion& motion, const CollocationStep& step, double t,
                               Eigen::VectorXd& y) const {
  basis_.to_state(motion.u, y.data());
  shear_.add(step.shear, t, y.data());
  y.head(f_) += origin_;
  y.tail(motion.w.size()) = motion.w;
}

void PairCoordinates::to_state_change(const Eigen::VectorXd& u, const CollocationStep& step, double t,
                                      Eigen::VectorXd& change) const {
  change.resize(2 * f_);
  basis_.to_state(u, change.data());
  shear_.add(step.shear, t, change.data());
}

void PairCoordinates::to_pair_change(Eigen::VectorXd& change, const CollocationStep& step, double t,
                                     Eigen::VectorXd& u) const {
  shear_.remove(step.shear, t, change.data());
  u.resize(2 * f_);
  basis_.to_pairs(change.data(), u.data());
}

void PairCoordinates::calc_drive(const Eigen::VectorXd& y, const Eigen::VectorXd& y_dot,
                                 const PairedMotion& motion, int node, CollocationStep& step) {
  auto pairs = step.drive.pairs.col(node);
  work_ = y;
  work_.head(f_) -= origin_;
  derivatives_ = y_dot;
  shear_.remove_from_derivatives(step.shear, lobatto::node(node) * step.length, work_.data(),
                                 derivatives_.data(), node, step.elastic);
  basis_.to_pairs(derivatives_.data(), pairs.data());
  basis_.blocks.subtract_product(motion.u, pairs);
  step.drive.rates.col(node) = y_dot.tail(motion.w.size());
}

double PairCoordinates::calc_norm(const PairedMotion& difference, const CollocationStep& step) {
  basis_.to_state(difference.u, work_.data());
  shear_.add(step.shear, 0.0, work_.data());
  work_.tail(difference.w.size()) = difference.w;
  return std::sqrt((work_.array() * inverse_allowed_.array()).square().mean());
}

}  // namespace sprung::dynamics

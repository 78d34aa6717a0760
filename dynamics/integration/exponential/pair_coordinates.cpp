#include "dynamics/integration/exponential/pair_coordinates.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

PairCoordinates::PairCoordinates(Eigen::Index num_freedoms, Eigen::Index size)
    : f_(num_freedoms),
      origin_(Eigen::VectorXd::Zero(num_freedoms)),
      inverse_allowed_(Eigen::VectorXd::Zero(size)),
      work_(Eigen::VectorXd::Zero(size)) {}

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

void PairCoordinates::to_pairs(const Eigen::VectorXd& y, PairedMotion& motion) {
  work_ = y;
  work_.head(f_) -= origin_;
  shear_.remove(work_.data());
  basis_.to_pairs(work_.data(), motion.u.data());
  motion.w = y.tail(motion.w.size());
}

void PairCoordinates::to_state(const PairedMotion& motion, Eigen::VectorXd& y) const {
  basis_.to_state(motion.u, y.data());
  shear_.add(y.data());
  y.head(f_) += origin_;
  y.tail(motion.w.size()) = motion.w;
}

void PairCoordinates::to_state_change(const Eigen::VectorXd& u, Eigen::VectorXd& change) const {
  change.resize(2 * f_);
  basis_.to_state(u, change.data());
  shear_.add(change.data());
}

void PairCoordinates::to_pair_change(Eigen::VectorXd& change, Eigen::VectorXd& u) const {
  shear_.remove(change.data());
  u.resize(2 * f_);
  basis_.to_pairs(change.data(), u.data());
}

void PairCoordinates::calc_drive(const Eigen::VectorXd& y_dot, const PairedMotion& motion, Drive& drive,
                                 int node) {
  auto pairs = drive.pairs.col(node);
  work_ = y_dot;
  shear_.remove(work_.data());
  basis_.to_pairs(work_.data(), pairs.data());
  basis_.blocks.subtract_product(motion.u, pairs);
  drive.rates.col(node) = y_dot.tail(motion.w.size());
}

// u̇ = B u + g has to hold in the new pairs, too: g' = (B u + g)' − B u'.
void PairCoordinates::convert(Eigen::MatrixXd& motions, Eigen::MatrixXd& drives) {
  for (Eigen::Index i = 0; i < motions.cols(); ++i) blocks().subtract_product(-motions.col(i), drives.col(i));
  shear_.convert(motions);
  shear_.convert(drives);
  for (Eigen::Index i = 0; i < motions.cols(); ++i) blocks().subtract_product(motions.col(i), drives.col(i));
}

double PairCoordinates::calc_norm(const PairedMotion& difference) {
  basis_.to_state(difference.u, work_.data());
  shear_.add(work_.data());
  work_.tail(difference.w.size()) = difference.w;
  return std::sqrt((work_.array() * inverse_allowed_.array()).square().mean());
}

}  // namespace sprung::dynamics

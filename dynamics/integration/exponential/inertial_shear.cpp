#include "dynamics/integration/exponential/inertial_shear.h"

#include <algorithm>

#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

void InertialShear::start(const VibrationBasis& basis, const std::vector<int>& elastic,
                          const Eigen::MatrixXd& mass) {
  f_ = mass.rows();
  elastic_ = elastic;
  others_.clear();
  for (int i = 0; i < f_; ++i) {
    if (!std::binary_search(elastic_.begin(), elastic_.end(), i)) others_.push_back(i);
  }
  if (!is_useful()) return;
  const auto o = static_cast<Eigen::Index>(others_.size()), e = static_cast<Eigen::Index>(elastic_.size());
  factor_.resize(o, o);
  inverse_ = factor_;
  coupling_.resize(e, o);
  has_inertia_ = calc_ratio(mass(Eigen::all, others_));
  first_ratio_ = ratio_;
  other_columns_.resize(2 * f_, 2 * o);
  other_columns_ << basis.inverse.leftCols(f_)(Eigen::all, others_),
      basis.inverse.rightCols(f_)(Eigen::all, others_);
  elastic_motion_ = Eigen::VectorXd::Zero(e);
  other_motion_ = Eigen::VectorXd::Zero(2 * o);
  moved_ = Eigen::MatrixXd::Zero(o, 3);
  loss_ = loss_rate_ = Eigen::VectorXd::Zero(2 * f_);
}

bool InertialShear::calc_ratio(const Eigen::MatrixXd& columns) {
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const auto column = columns.col(static_cast<Eigen::Index>(i));
    for (std::size_t k = 0; k < others_.size(); ++k)
      factor_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = column[others_[k]];
    for (std::size_t k = 0; k < elastic_.size(); ++k)
      coupling_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = column[elastic_[k]];
  }
  inverse_.setIdentity();
  if (!support::solve_positive_definite_in_place(factor_, inverse_)) return false;
  ratio_ = coupling_.lazyProduct(inverse_).transpose();
  return ratio_.allFinite();
}

bool InertialShear::calc_shear(const Eigen::MatrixXd& columns, Eigen::MatrixXd& shear) {
  if (!has_inertia_ || !calc_ratio(columns)) return false;
  shear = first_ratio_ - ratio_;
  return true;
}

// State q_o += ΔG q_e, v_o += ΔG v_e, or −=.
void InertialShear::shift(double factor, const ShearCourse& course, double t, double* state) const {
  if (!is_useful()) return;
  for (double* half : {state, state + f_}) {
    for (std::size_t k = 0; k < elastic_.size(); ++k)
      elastic_motion_[static_cast<Eigen::Index>(k)] = half[elastic_[k]];
    support::multiply(course.rows(), elastic_motion_.data(), other_motion_.data());
    const double *at_start = other_motion_.data(), *rate = at_start + others_.size();
    for (std::size_t i = 0; i < others_.size(); ++i) half[others_[i]] += factor * (at_start[i] + t * rate[i]);
  }
}

ElasticMotion InertialShear::no_motion() const {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(std::ssize(elastic_), lobatto::kNumNodes);
  return {none, none, none};
}

void InertialShear::remove_from_derivatives(const ShearCourse& course, double t, const double* state,
                                            double* derivatives, int node, ElasticMotion& motion) const {
  if (!is_useful()) return;
  double* positions = motion.positions.col(node).data();
  double* velocities = motion.velocities.col(node).data();
  double* accelerations = motion.accelerations.col(node).data();
  for (std::size_t k = 0; k < elastic_.size(); ++k) {
    positions[k] = state[elastic_[k]];
    velocities[k] = state[f_ + elastic_[k]];
    accelerations[k] = derivatives[f_ + elastic_[k]];
  }
  // What its rate adds to the derivatives, and what it adds as to a state.
  shift(-1.0, course, t, derivatives);
  const auto remove_rate = [&](const double* elastic, double* half) {
    support::multiply(course.rows(), elastic, other_motion_.data());
    const double* rate = other_motion_.data() + others_.size();
    for (std::size_t i = 0; i < others_.size(); ++i) half[others_[i]] -= rate[i];
  };
  remove_rate(positions, derivatives);
  remove_rate(velocities, derivatives + f_);
}

// A shear C of elastic motion x_e moves the pairs by −T⁻¹ (C x_e); here C is t times the change.
void InertialShear::change_rate(const Eigen::MatrixXd& change, const ElasticMotion& motion, int node,
                                double t, const PairBlocks& blocks, lobatto::NodeValues& drive) {
  support::multiply(change, motion.positions.col(node).data(), moved_.col(0).data());
  support::multiply(change, motion.velocities.col(node).data(), moved_.col(1).data());
  support::multiply(change, motion.accelerations.col(node).data(), moved_.col(2).data());
  const Eigen::Index o = moved_.rows();
  other_motion_.head(o) = moved_.col(0) + t * moved_.col(1);
  other_motion_.tail(o) = moved_.col(1) + t * moved_.col(2);
  support::multiply(other_columns_, other_motion_.data(), loss_rate_.data());
  other_motion_.head(o) = t * moved_.col(0);
  other_motion_.tail(o) = t * moved_.col(1);
  support::multiply(other_columns_, other_motion_.data(), loss_.data());
  blocks.subtract_product(-loss_, drive.col(node));
  drive.col(node) -= loss_rate_;
}

}  // namespace sprung::dynamics

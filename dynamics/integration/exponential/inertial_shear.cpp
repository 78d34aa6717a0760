#include "dynamics/integration/exponential/inertial_shear.h"

#include <algorithm>

#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

namespace {

// The indices, and those of the velocities that belong to them.
std::vector<int> with_velocities(std::vector<int> indices, Eigen::Index num_freedoms) {
  const std::size_t count = indices.size();
  for (std::size_t k = 0; k < count; ++k) indices.push_back(indices[k] + static_cast<int>(num_freedoms));
  return indices;
}

}  // namespace

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
  ratio_.resize(o, e);
  has_inertia_ = calc_ratio(mass(Eigen::all, others_));
  first_ratio_ = ratio_;
  shear_ = change_ = Eigen::MatrixXd::Zero(o, e);
  elastic_positions_ = basis.T(elastic_, Eigen::all).transpose();
  elastic_velocities_ = basis.T(with_velocities(elastic_, f_), Eigen::all).bottomRows(e).transpose();
  change_rows_ = Eigen::MatrixXd::Zero(2 * o, 2 * f_);
  other_columns_ = basis.inverse(Eigen::all, with_velocities(others_, f_));
  elastic_motion_ = Eigen::VectorXd::Zero(e);
  other_motion_ = Eigen::VectorXd::Zero(2 * o);
  loss_ = Eigen::VectorXd::Zero(2 * f_);
}

bool InertialShear::calc_ratio(const Eigen::MatrixXd& columns) {
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const auto column = columns.col(static_cast<Eigen::Index>(i));
    for (std::size_t k = 0; k < others_.size(); ++k)
      factor_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = column[others_[k]];
    for (std::size_t k = 0; k < elastic_.size(); ++k)
      ratio_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = column[elastic_[k]];
  }
  return support::solve_positive_definite_in_place(factor_, ratio_) && ratio_.allFinite();
}

bool InertialShear::follow(const Eigen::MatrixXd& columns) {
  if (!has_inertia_ || !calc_ratio(columns)) return false;
  change_ = -shear_;
  shear_ = first_ratio_ - ratio_;
  change_ += shear_;
  const Eigen::Index o = change_.rows();
  for (Eigen::Index i = 0; i < o; ++i) {
    elastic_motion_ = change_.row(i);
    for (const Eigen::Index half : {Eigen::Index{0}, o}) {
      support::multiply(half == 0 ? elastic_positions_ : elastic_velocities_, elastic_motion_.data(),
                        loss_.data());
      change_rows_.row(half + i) = loss_;
    }
  }
  return true;
}

// u −= C (ΔG applied to the elastic motion of u), C = other_columns_. Few freedoms are not elastic, so the
// rows of ΔG times T are found once for all columns.
void InertialShear::convert(Eigen::MatrixXd& pairs) {
  for (auto u : pairs.colwise()) {
    support::multiply(change_rows_, u.data(), other_motion_.data());
    support::multiply(other_columns_, other_motion_.data(), loss_.data());
    u -= loss_;
  }
}

void InertialShear::shift(double factor, double* state) const {
  if (!is_useful()) return;
  for (double* half : {state, state + f_}) {
    for (std::size_t k = 0; k < elastic_.size(); ++k)
      elastic_motion_[static_cast<Eigen::Index>(k)] = half[elastic_[k]];
    support::multiply(shear_, elastic_motion_.data(), other_motion_.data());
    for (std::size_t i = 0; i < others_.size(); ++i)
      half[others_[i]] += factor * other_motion_[static_cast<Eigen::Index>(i)];
  }
}

}  // namespace sprung::dynamics

#include "dynamics/statistics/moment_density.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kLeastOfBody = 0.1;   // of the largest r.m.s. change from output to output along the body
constexpr double kLeastChange = 0.01;  // of the largest moment

void calc_moments(const BodySections& body, Eigen::VectorXd& moments) {
  const Eigen::Matrix3Xd& stations = body.has_loads() ? body.from_loads() : body.from_modes();
  for (Eigen::Index i = 0; i < moments.size(); ++i)
    moments[i] = 0.5 * (stations(2, 2 * i) + stations(2, 2 * i + 1));
}

}  // namespace

MomentDensity::MomentDensity(const BodySections& body) {
  const bool has_moments = body.has_loads() || body.has_modes();
  const Eigen::Index num_elements = has_moments ? body.positions().rows() / 2 : Eigen::Index{0};
  elements_.resize(static_cast<std::size_t>(num_elements));
  first_ = moments_ = Eigen::VectorXd::Zero(num_elements);
}

void MomentDensity::add_output(const BodySections& body) {
  calc_moments(body, moments_);
  if (num_outputs_++ == 0) first_ = moments_;
  largest_ = std::max(largest_, moments_.lpNorm<Eigen::Infinity>());
  moments_ -= first_;
  for (std::size_t i = 0; i < elements_.size(); ++i)
    elements_[i].add_sample(moments_[static_cast<Eigen::Index>(i)]);
}

void MomentDensity::add_between(const BodySections& body) {
  if (num_outputs_ == 0) return;
  calc_moments(body, moments_);
  moments_ -= first_;
  for (std::size_t i = 0; i < elements_.size(); ++i)
    elements_[i].add_between(moments_[static_cast<Eigen::Index>(i)]);
}

double MomentDensity::floor() const {
  double most = 0.0;
  for (const SampleDensity& element : elements_) most = std::max(most, element.step_rms());
  return std::max(kLeastOfBody * most, kLeastChange * largest_);
}

}  // namespace sprung::dynamics

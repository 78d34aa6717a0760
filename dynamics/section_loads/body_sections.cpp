#include "dynamics/section_loads/body_sections.h"

#include <algorithm>

#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/join_columns.h"
#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

namespace {

constexpr double kLeastGravity =
    1.0;  // m/s², in the weight beside which moments are judged, also without gravity

}  // namespace

BodySections::BodySections(const Model& model, int body, const reduce::Superelement& superelement,
                           const std::vector<VehiclePoint>& points)
    : body_(static_cast<std::size_t>(body)), loads_(model, body, superelement, points) {
  const Body& moving = model.bodies[body_];
  name_ = moving.name;
  first_ = moving.first_coordinate;
  num_modes_ = moving.num_modes();
  has_whole_basis_ = num_modes_ == superelement.num_modes();
  is_certified_ = superelement.certificate && superelement.certificate->is_bounded();
  const Eigen::Index stations = 2 * superelement.elements.cols();
  positions_.resize(stations, 2);
  for (Eigen::Index station = 0; station < stations; ++station) {
    const int node = superelement.elements(station % 2, station / 2);
    positions_.row(station) = superelement.node_positions.col(node).transpose();
  }
  length_ = (positions_.colwise().maxCoeff() - positions_.colwise().minCoeff()).norm();
  weight_ = moving.mass * std::max(model.gravity.norm(), kLeastGravity);
  if (const std::optional<reduce::SectionSizes>& of_elements = superelement.section_sizes) {
    const auto at_ends = [](const Eigen::VectorXd& values) -> Eigen::VectorXd {
      return values.transpose().replicate(2, 1).reshaped();
    };
    sizes_ = {.area = at_ends(of_elements->area), .modulus = at_ends(of_elements->modulus)};
  }
  std::vector<int> columns;
  for (const int number : moving.mode_numbers) columns.push_back(number - 1);
  by_mode_ = superelement.resultants(Eigen::all, columns);
  from_modes_ = from_loads_ = Eigen::Matrix3Xd::Zero(3, stations);
  if (!superelement.section_loads) return;
  by_load_ = combine(*superelement.section_loads, columns);
  causes_ = Eigen::VectorXd::Zero(by_load_.cols() + num_modes_);
  if (has_modes()) prepare_missing(moving, superelement, columns);
  if (moving.stiffening) by_load_.resize(0, 0);
}

Eigen::MatrixXd BodySections::combine(const reduce::UnitLoads& unit, const std::vector<int>& columns) const {
  Eigen::MatrixXd combined(unit.acceleration.rows(), loads_.size() + 2 * num_modes_);
  combined << loads_.combine(unit.point_load, unit.acceleration),
      unit.modal_acceleration(Eigen::all, columns), unit.turned_acceleration(Eigen::all, columns);
  return combined;
}

// The mean moment of each element of vectors, elements×vectors. @param resultants  3 stations × vectors
Eigen::MatrixXd BodySections::average_moments(const Eigen::MatrixXd& resultants) const {
  Eigen::MatrixXd moments(positions_.rows() / 2, resultants.cols());
  for (Eigen::Index e = 0; e < moments.rows(); ++e)
    moments.row(e) = 0.5 * (resultants.row(6 * e + 2) + resultants.row(6 * e + 5));
  return moments;
}

// Those of the named points, 3 points × vectors.
Eigen::MatrixXd BodySections::pick_deflections(const reduce::Superelement& superelement,
                                               const std::vector<int>& columns) const {
  Eigen::MatrixXd picked(3 * static_cast<Eigen::Index>(superelement.points.size()),
                         static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index p = 0; 3 * p < picked.rows(); ++p) {
    const int node = superelement.points[static_cast<std::size_t>(p)].node;
    picked.middleRows<3>(3 * p) = superelement.shapes(Eigen::seqN(3 * node, 3), columns);
  }
  return picked;
}

void BodySections::prepare_missing(const Body& body, const reduce::Superelement& superelement,
                                   const std::vector<int>& columns) {
  const Eigen::Index num_elements = superelement.elements.cols();
  Eigen::MatrixXd by_load = average_moments(by_load_);
  for (Eigen::Index e = 0; e < num_elements; ++e) {
    const double length = (positions_.row(2 * e + 1) - positions_.row(2 * e)).norm();
    by_load.row(e) -= length / 12.0 * (by_load_.row(6 * e + 1) - by_load_.row(6 * e + 4));
  }
  missing_moment_by_ = support::join_columns(by_load, -average_moments(by_mode_));
  delay_ = body.damping.diagonal().cwiseQuotient(body.stiffness.diagonal());
  if (body.stiffening) amplitude_by_load_ = calc_amplitudes(superelement, columns, columns);
  amplitudes_ = Eigen::VectorXd::Zero(num_modes_);
  missing_moment_ = basis_missing_moment_ = Eigen::VectorXd::Zero(num_elements);
  for (const reduce::NamedPoint& point : superelement.points) points_.push_back(name_ + "." + point.name);
  deflection_by_mode_ = pick_deflections(superelement, columns);
  missing_deflection_by_ =
      support::join_columns(combine(*superelement.point_deflections, columns), -deflection_by_mode_);
  deflections_ = missing_deflections_ = basis_missing_deflections_ =
      Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(superelement.points.size()));
  if (!has_whole_basis_) prepare_left_out(superelement, columns);
}

void BodySections::prepare_left_out(const reduce::Superelement& superelement,
                                    const std::vector<int>& columns) {
  std::vector<int> others;
  for (int vector = 0; vector < superelement.num_modes(); ++vector)
    if (!std::binary_search(columns.begin(), columns.end(), vector)) others.push_back(vector);
  const Eigen::MatrixXd amplitudes = calc_amplitudes(superelement, others, columns);
  left_out_moment_by_ = average_moments(superelement.resultants(Eigen::all, others)) * amplitudes;
  left_out_deflection_by_ = pick_deflections(superelement, others) * amplitudes;
}

// Amplitudes of vectors at rest (section_loads, eq. 5), vectors × columns of by_load_.
// @param columns  the modes
Eigen::MatrixXd BodySections::calc_amplitudes(const reduce::Superelement& superelement,
                                              const std::vector<int>& vectors,
                                              const std::vector<int>& columns) const {
  const auto num_vectors = static_cast<Eigen::Index>(vectors.size());
  const reduce::InertiaInvariants& inertia = superelement.inertia;
  const Eigen::MatrixXd of_points = pick_deflections(superelement, vectors).transpose();
  Eigen::MatrixXd of_frame(num_vectors, 4), load(num_vectors, by_load_.cols());
  of_frame << -inertia.P(Eigen::all, vectors).transpose(), -inertia.c(vectors).transpose(),
      inertia.d(vectors).transpose();
  load << loads_.combine(of_points, of_frame), -inertia.M_ff(vectors, columns), inertia.B(vectors, columns);
  return support::solve_positive_definite(superelement.stiffness(vectors, vectors), load);
}

void BodySections::update(std::span<const Wrench> loads, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                          const Eigen::VectorXd& v_dot) {
  const auto eta = q.segment(first_ + 3, num_modes_), eta_dot = v.segment(first_ + 3, num_modes_),
             eta_ddot = v_dot.segment(first_ + 3, num_modes_);
  loads_.update(loads, q, v, v_dot);
  if (has_modes()) support::multiply(by_mode_, eta.data(), from_modes_.data());
  if (!has_loads() && !has_missing()) return;
  const double rate = v[first_ + 2], turning = v_dot[first_ + 2];
  causes_.head(loads_.size()) = loads_.coefficients();
  causes_.segment(loads_.size(), num_modes_) = eta_ddot - rate * rate * eta;
  causes_.segment(loads_.size() + num_modes_, num_modes_) = turning * eta + 2.0 * rate * eta_dot;
  if (has_loads()) support::multiply(by_load_, causes_.data(), from_loads_.data());
  if (!has_missing()) return;
  if (amplitude_by_load_.size() > 0) {
    support::multiply(amplitude_by_load_, causes_.data(), amplitudes_.data());
  } else {
    amplitudes_ = eta + delay_.cwiseProduct(eta_dot);
  }
  causes_.tail(num_modes_) = amplitudes_;
  support::multiply(missing_moment_by_, causes_.data(), missing_moment_.data());
  support::multiply(missing_deflection_by_, causes_.data(), missing_deflections_.data());
  support::multiply(deflection_by_mode_, eta.data(), deflections_.data());
  deflections_ += missing_deflections_;
  if (left_out_moment_by_.size() > 0) {
    support::multiply(left_out_moment_by_, causes_.data(), basis_missing_moment_.data());
    support::multiply(left_out_deflection_by_, causes_.data(), basis_missing_deflections_.data());
    basis_missing_moment_ = missing_moment_ - basis_missing_moment_;
    basis_missing_deflections_ = missing_deflections_ - basis_missing_deflections_;
  } else {
    basis_missing_moment_ = missing_moment_;
    basis_missing_deflections_ = missing_deflections_;
  }
}

}  // namespace sprung::dynamics

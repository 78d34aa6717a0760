#include "reduce/reduction/distance_weighted_mass.h"

#include <array>

#include "fem/frame_sums.h"

namespace sprung::reduce {

namespace {

// Gauss–Legendre on −1 … 1, exact to degree 7: two cubics and x.
constexpr double kInner = 0.33998104358485626, kOuter = 0.86113631159405258;
constexpr double kInnerWeight = 0.65214515486254614, kOuterWeight = 0.34785484513745386;
constexpr std::array<std::array<double, 2>, 4> kGaussPoints{
    {{-kOuter, kOuterWeight}, {-kInner, kInnerWeight}, {kInner, kInnerWeight}, {kOuter, kOuterWeight}}};

fem::Matrix6 calc_element(const fem::BeamElement& element, const Eigen::Vector2d& origin) {
  const double length = (element.second - element.first).norm();
  fem::Matrix6 own = fem::Matrix6::Zero();
  for (const auto& [point, weight] : kGaussPoints) {
    const double xi = 0.5 * (1.0 + point);
    const double dm = 0.5 * weight * length * element.properties.mass_per_length;
    const double x = (1.0 - xi) * element.first.x() + xi * element.second.x() - origin.x();
    const Eigen::Matrix<double, 2, 6> N =
        fem::calc_shape_functions(length, element.properties, xi).topRows<2>();
    own += dm * x * N.transpose() * N;
  }
  const fem::Matrix6 T = fem::calc_rotation(element);
  return T.transpose() * own * T;
}

}  // namespace

Eigen::SparseMatrix<double> calc_distance_weighted_mass(const fem::BeamModel& model,
                                                        const Eigen::Vector2d& origin) {
  fem::check_beam_model(model, "calc_distance_weighted_mass");
  Eigen::SparseMatrix<double> result = fem::make_frame_sum(model.mesh);
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    fem::add_at_element(result, model.mesh.elements[static_cast<std::size_t>(e)],
                        calc_element(fem::make_element(model, e), origin));
  }
  for (const fem::PointMass& point : model.point_masses) {
    const double moment = point.mass * (model.mesh.node_positions(0, point.node) - origin.x());
    fem::add_at_node(result, point.node, Eigen::Vector3d(moment, moment, 0.0).asDiagonal());
  }
  if (!model.couplings.empty()) result = fem::eliminate_followers(model.couplings, result);
  return result;
}

}  // namespace sprung::reduce

#include "fem/mass_moments.h"

#include <array>
#include <stdexcept>

#include "fem/frame_sums.h"
#include "fem/gauss_points.h"

namespace sprung::fem {

namespace {

using Row6 = Eigen::Matrix<double, 1, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

std::array<int, 6> get_dofs(const Mesh::Element& nodes) {
  return {3 * nodes.first,  3 * nodes.first + 1,  3 * nodes.first + 2,
          3 * nodes.second, 3 * nodes.second + 1, 3 * nodes.second + 2};
}

void add(Eigen::VectorXd& vector, const std::array<int, 6>& dofs, const Vector6& values) {
  for (int i = 0; i < 6; ++i) vector[dofs[static_cast<std::size_t>(i)]] += values[i];
}

// Adds a mass dm with rotary inertia dI at position r to the moments without shape functions.
void add_piece(MassMoments& moments, const Eigen::Vector2d& r, double dm, double dI) {
  moments.mass += dm;
  moments.first_moment += dm * r;
  moments.xx += dm * r.x() * r.x();
  moments.xy += dm * r.x() * r.y();
  moments.yy += dm * r.y() * r.y();
  moments.rotary += dI;
}

void add_element(MassMoments& moments, const BeamElement& element, const Mesh::Element& nodes,
                 const Eigen::Vector2d& origin) {
  static const std::array<GaussPoint, 4> kGaussPoints = make_gauss_points();
  const double length = calc_length(element);
  const Matrix6 T = calc_rotation(element);
  const Eigen::Matrix2d R = T.topLeftCorner<2, 2>().transpose();  // own axes → mesh axes
  Vector6 N_x = Vector6::Zero(), N_y = Vector6::Zero(), rotary_N = Vector6::Zero();
  Vector6 x_N_x = Vector6::Zero(), x_N_y = Vector6::Zero(), y_N_x = Vector6::Zero(), y_N_y = Vector6::Zero();
  Matrix6 NxNx = Matrix6::Zero(), NxNy = Matrix6::Zero(), NyNy = Matrix6::Zero(), rotary_NN = Matrix6::Zero();
  for (const auto& [xi, weight] : kGaussPoints) {
    const double dm = weight * length * element.properties.mass_per_length;
    const double dI = weight * length * element.properties.rotary_inertia;
    const Eigen::Vector2d r = (1.0 - xi) * (element.first - origin) + xi * (element.second - origin);
    const Eigen::Matrix<double, 3, 6> N = calc_shape_functions(length, element.properties, xi) * T;
    const Row6 X = R.row(0) * N.topRows<2>();
    const Row6 Y = R.row(1) * N.topRows<2>();
    const Row6 Psi = N.row(2);
    add_piece(moments, r, dm, dI);
    N_x += dm * X.transpose();
    N_y += dm * Y.transpose();
    x_N_x += dm * r.x() * X.transpose();
    x_N_y += dm * r.x() * Y.transpose();
    y_N_x += dm * r.y() * X.transpose();
    y_N_y += dm * r.y() * Y.transpose();
    rotary_N += dI * Psi.transpose();
    NxNx += dm * X.transpose() * X;
    NxNy += dm * X.transpose() * Y;
    NyNy += dm * Y.transpose() * Y;
    rotary_NN += dI * Psi.transpose() * Psi;
  }
  const std::array<int, 6> dofs = get_dofs(nodes);
  add(moments.N_x, dofs, N_x);
  add(moments.N_y, dofs, N_y);
  add(moments.x_N_x, dofs, x_N_x);
  add(moments.x_N_y, dofs, x_N_y);
  add(moments.y_N_x, dofs, y_N_x);
  add(moments.y_N_y, dofs, y_N_y);
  add(moments.rotary_N, dofs, rotary_N);
  add_at_element(moments.NxNx, nodes, NxNx);
  add_at_element(moments.NxNy, nodes, NxNy);
  add_at_element(moments.NyNy, nodes, NyNy);
  add_at_element(moments.rotary_NN, nodes, rotary_NN);
}

void add_point_mass(MassMoments& moments, const PointMass& point, const Eigen::Vector2d& r) {
  const int x = 3 * point.node;
  const int y = x + 1;
  const int psi = x + 2;
  add_piece(moments, r, point.mass, point.inertia);
  moments.N_x[x] += point.mass;
  moments.N_y[y] += point.mass;
  moments.x_N_x[x] += point.mass * r.x();
  moments.x_N_y[y] += point.mass * r.x();
  moments.y_N_x[x] += point.mass * r.y();
  moments.y_N_y[y] += point.mass * r.y();
  moments.rotary_N[psi] += point.inertia;
  const auto add_entry = [&](Eigen::SparseMatrix<double>& sum, int row, int column, double value) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    matrix(row, column) = value;
    add_at_node(sum, point.node, matrix);
  };
  add_entry(moments.NxNx, 0, 0, point.mass);
  add_entry(moments.NxNy, 0, 1, point.mass);
  add_entry(moments.NyNy, 1, 1, point.mass);
  add_entry(moments.rotary_NN, 2, 2, point.inertia);
}

}  // namespace

MassMoments calc_mass_moments(const BeamModel& model, const Eigen::Vector2d& origin) {
  check_beam_model(model, "calc_mass_moments");
  if (!origin.allFinite()) throw std::invalid_argument("calc_mass_moments: origin is not finite");
  const Eigen::Index num_dofs = 3 * model.mesh.num_nodes();
  MassMoments moments;
  for (Eigen::VectorXd* vector : {&moments.N_x, &moments.N_y, &moments.x_N_x, &moments.x_N_y, &moments.y_N_x,
                                  &moments.y_N_y, &moments.rotary_N}) {
    vector->setZero(num_dofs);
  }
  moments.NxNx = moments.NxNy = moments.NyNy = moments.rotary_NN = make_frame_sum(model.mesh);
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    add_element(moments, make_element(model, e), model.mesh.elements[static_cast<std::size_t>(e)], origin);
  }
  for (const PointMass& point : model.point_masses) {
    add_point_mass(moments, point, model.mesh.node_positions.col(point.node) - origin);
  }
  if (model.couplings.empty()) return moments;
  for (Eigen::SparseMatrix<double>* matrix :
       {&moments.NxNx, &moments.NxNy, &moments.NyNy, &moments.rotary_NN})
    *matrix = eliminate_followers(model.couplings, *matrix);
  for (Eigen::VectorXd* vector : {&moments.N_x, &moments.N_y, &moments.x_N_x, &moments.x_N_y, &moments.y_N_x,
                                  &moments.y_N_y, &moments.rotary_N}) {
    *vector = move_loads_to_leaders(model.couplings, *vector);
  }
  return moments;
}

}  // namespace sprung::fem

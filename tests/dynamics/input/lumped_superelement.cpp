#include "tests/dynamics/input/lumped_superelement.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

namespace sprung::test {

namespace {

// Shapes without symmetry, normalised to ∫φᵀφ dm = 1.
Eigen::MatrixXd make_shapes(const LumpedBody& body) {
  const Eigen::Index num_nodes = static_cast<Eigen::Index>(body.nodes.size());
  const Eigen::Index n = static_cast<Eigen::Index>(body.frequencies.size());
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3 * num_nodes, n);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 1; i < num_nodes; ++i) {
    for (Eigen::Index row = 3 * i; row < 3 * i + 3; ++row) {
      for (Eigen::Index k = 0; k < n; ++k) {
        shapes(row, k) = std::sin(static_cast<double>(1 + row * row) * (0.7 + 0.31 * static_cast<double>(k)));
      }
    }
    const Eigen::MatrixXd translation = shapes.block(3 * i, 0, 2, n);
    M += body.nodes[static_cast<std::size_t>(i)].mass * translation.transpose() * translation;
  }
  return M.llt().matrixL().solve(shapes.transpose()).transpose();
}

reduce::InertiaInvariants sum_inertia(const LumpedBody& body, const Eigen::MatrixXd& shapes) {
  const Eigen::Index n = shapes.cols();
  const Eigen::RowVectorXd none = Eigen::RowVectorXd::Zero(n);
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(n, n);
  reduce::InertiaInvariants sum;
  sum.P = Eigen::Matrix2Xd::Zero(2, n);
  sum.x_phi_x = sum.x_phi_y = sum.y_phi_x = sum.y_phi_y = none;
  sum.phi_x_phi_x = sum.phi_x_phi_y = sum.phi_y_phi_y = nothing;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    const double mass = body.nodes[i].mass;
    const Eigen::Vector2d& r = body.nodes[i].position;
    const Eigen::RowVectorXd phi_x = shapes.row(3 * static_cast<Eigen::Index>(i));
    const Eigen::RowVectorXd phi_y = shapes.row(3 * static_cast<Eigen::Index>(i) + 1);
    sum.mass += mass;
    sum.first_moment += mass * r;
    sum.second_moment += mass * r.squaredNorm();
    sum.P.row(0) += mass * phi_x;
    sum.P.row(1) += mass * phi_y;
    sum.x_phi_x += mass * r.x() * phi_x;
    sum.x_phi_y += mass * r.x() * phi_y;
    sum.y_phi_x += mass * r.y() * phi_x;
    sum.y_phi_y += mass * r.y() * phi_y;
    sum.phi_x_phi_x += mass * phi_x.transpose() * phi_x;
    sum.phi_x_phi_y += mass * phi_x.transpose() * phi_y;
    sum.phi_y_phi_y += mass * phi_y.transpose() * phi_y;
  }
  sum.c = sum.x_phi_y - sum.y_phi_x;
  sum.d = sum.x_phi_x + sum.y_phi_y;
  sum.M_ff = sum.phi_x_phi_x + sum.phi_y_phi_y;
  sum.B = sum.phi_x_phi_y - sum.phi_x_phi_y.transpose();
  return sum;
}

}  // namespace

reduce::Superelement make_lumped_superelement(const LumpedBody& body) {
  const Eigen::Index num_nodes = static_cast<Eigen::Index>(body.nodes.size());
  const Eigen::Index n = static_cast<Eigen::Index>(body.frequencies.size());
  reduce::Superelement s;
  s.name = body.name;
  s.node_positions.resize(2, num_nodes);
  s.elements.resize(2, num_nodes - 1);
  for (int i = 0; i < num_nodes; ++i) {
    const LumpedBody::Node& node = body.nodes[static_cast<std::size_t>(i)];
    s.node_ids.push_back(i + 1);
    s.node_positions.col(i) = node.position;
    if (!node.name.empty()) s.points.push_back({node.name, i});
    if (i > 0) s.elements.col(i - 1) << 0, i;
  }
  s.element_sections.assign(static_cast<std::size_t>(num_nodes - 1), "none");
  s.frequency_hz = Eigen::Map<const Eigen::VectorXd>(body.frequencies.data(), n);
  s.damping_ratio = Eigen::VectorXd::Constant(n, body.damping_ratio);
  s.cluster = Eigen::VectorXi::Ones(n);
  for (int k = 1; k < n; ++k) {
    s.cluster[k] = s.cluster[k - 1] + (s.frequency_hz[k] == s.frequency_hz[k - 1] ? 0 : 1);
  }
  s.shapes = make_shapes(body);
  s.num_elastic_dofs = 3 * (num_nodes - 1);
  s.inertia = sum_inertia(body, s.shapes);
  const Eigen::VectorXd omega = 2.0 * std::numbers::pi * s.frequency_hz;
  s.mass = Eigen::MatrixXd::Identity(n, n);
  s.stiffness = omega.array().square().matrix().asDiagonal();
  s.damping = (2.0 * body.damping_ratio * omega).asDiagonal();
  s.resultants = Eigen::MatrixXd::Zero(6 * (num_nodes - 1), n);
  return s;
}

std::filesystem::path write_lumped_superelement(const LumpedBody& body, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / (body.name + ".h5");
  reduce::write_superelement(make_lumped_superelement(body), path);
  return path;
}

}  // namespace sprung::test

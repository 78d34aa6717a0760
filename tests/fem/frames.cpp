#include "tests/fem/frames.h"

#include <Eigen/Eigenvalues>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/catch.h"

namespace sprung::fem::test {

BeamProperties make_thick_properties() {
  return {.axial_rigidity = 3.71e8,
          .bending_rigidity = 2.93e6,
          .shear_rigidity = 1.17e8,
          .mass_per_length = 41.3,
          .rotary_inertia = 0.83};
}

BeamProperties make_thin_properties() {
  return {.axial_rigidity = 2.31e8,
          .bending_rigidity = 1.87e5,
          .shear_rigidity = std::numeric_limits<double>::infinity(),
          .mass_per_length = 13.7,
          .rotary_inertia = 0.0};
}

BeamModel make_general_frame() {
  BeamModel model;
  Mesh& mesh = model.mesh;
  mesh.node_ids = {3, 4, 8, 11, 20};
  mesh.node_positions.resize(2, 5);
  mesh.node_positions.transpose() << 0.31, -0.42, 1.73, 0.11, 0.94, 1.37, 2.61, 1.02, 3.35, 0.28;
  mesh.section_names = {"thick", "thin"};
  mesh.elements = {{0, 1, 0}, {1, 2, 1}, {2, 0, 0}, {1, 3, 0}, {4, 3, 1}};
  mesh.named_nodes = {{"corner", 1}, {"tip", 4}};
  model.sections = {make_thick_properties(), make_thin_properties()};
  model.point_masses = {{.node = 4, .mass = 7.3, .inertia = 0.21},
                        {.node = 2, .mass = 11.9, .inertia = 0.37}};
  return model;
}

BeamModel make_straight_beam(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int num_elements,
                             const BeamProperties& properties) {
  BeamModel model;
  Mesh& mesh = model.mesh;
  mesh.section_names = {"beam"};
  mesh.node_positions.resize(2, num_elements + 1);
  for (int node = 0; node <= num_elements; ++node) {
    const double s = static_cast<double>(node) / num_elements;
    mesh.node_ids.push_back(node + 1);
    mesh.node_positions.col(node) = (1.0 - s) * from + s * to;
    if (node > 0) mesh.elements.push_back({node - 1, node, 0});
  }
  model.sections = {properties};
  return model;
}

BeamModel renumber(const BeamModel& model, const std::vector<int>& order) {
  BeamModel result = model;
  for (std::size_t node = 0; node < order.size(); ++node) {
    const auto other = static_cast<std::size_t>(order[node]);
    result.mesh.node_ids[other] = model.mesh.node_ids[node];
    result.mesh.node_positions.col(order[node]) =
        model.mesh.node_positions.col(static_cast<Eigen::Index>(node));
  }
  const auto renumbered = [&](int node) { return order[static_cast<std::size_t>(node)]; };
  for (Mesh::Element& element : result.mesh.elements) {
    element = {renumbered(element.first), renumbered(element.second), element.section};
  }
  for (Mesh::NamedNode& named : result.mesh.named_nodes) named.node = renumbered(named.node);
  for (PointMass& point : result.point_masses) point.node = renumbered(point.node);
  return result;
}

std::vector<QuadraturePoint> make_quadrature() {
  const double inner = 0.538469310105683, outer = 0.906179845938664;
  const double inner_weight = 0.478628670499366, outer_weight = 0.236926885056189;
  return {{0.5 - 0.5 * outer, 0.5 * outer_weight},
          {0.5 - 0.5 * inner, 0.5 * inner_weight},
          {0.5, 0.5 * 0.568888888888889},
          {0.5 + 0.5 * inner, 0.5 * inner_weight},
          {0.5 + 0.5 * outer, 0.5 * outer_weight}};
}

Eigen::VectorXd calc_frequencies(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(M, K, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) throw std::runtime_error("calc_frequencies: no convergence");
  const Eigen::VectorXd omega = solver.eigenvalues().reverse().cwiseInverse().cwiseSqrt();
  return omega / (2.0 * std::numbers::pi);
}

Eigen::MatrixXd remove_node(const Eigen::MatrixXd& matrix, int node) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index dof = 0; dof < matrix.rows(); ++dof) {
    if (dof / 3 != node) kept.push_back(dof);
  }
  return matrix(kept, kept);
}

double calc_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd difference = a - b;
  return difference.lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

std::filesystem::path get_data(std::string_view name) {
  return std::filesystem::path(SPRUNG_FEM_TEST_DATA) / name;
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

std::filesystem::path write_file(std::string_view name, std::string_view text) {
  std::filesystem::path path(name);
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string replace(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("nothing to replace: " + std::string(from));
  return text.replace(at, from.size(), to);
}

void check_contains(const std::string& message, std::string_view text) {
  INFO("expected to contain: " << text);
  INFO("message: " << message);
  CHECK(message.find(text) != std::string::npos);
}

}  // namespace sprung::fem::test

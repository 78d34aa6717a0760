#include "reduce/superelement/superelement_fault.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "tools/support/dense/dense_solvers.h"

namespace sprung::reduce {

namespace {

using Fault = std::optional<SuperelementFault>;

// Modal matrices are symmetrised before they are written: what is left is a file that somebody else made.
constexpr double kSymmetryTolerance = 1e-12;
// Modes of equal frequency may stand in any order (relative gap of a cluster; reduce, "One basis").
constexpr double kOrderTolerance = 1e-6;

Fault check_size(const std::string& dataset, Eigen::Index rows, Eigen::Index columns,
                 Eigen::Index wanted_rows, Eigen::Index wanted_columns) {
  if (rows == wanted_rows && columns == wanted_columns) return {};
  return SuperelementFault{
      dataset, fmt::format("has {}×{} values, expected {}×{}", rows, columns, wanted_rows, wanted_columns)};
}

template <typename Matrix>
Fault check_matrix(const std::string& dataset, const Matrix& matrix, Eigen::Index rows,
                   Eigen::Index columns) {
  if (Fault fault = check_size(dataset, matrix.rows(), matrix.cols(), rows, columns)) return fault;
  if (matrix.allFinite()) return {};
  return SuperelementFault{dataset, "contains NaN or infinity"};
}

// sign +1: symmetric, −1: skew.
Fault check_symmetry(const std::string& dataset, const Eigen::MatrixXd& matrix, double sign) {
  const double size = matrix.cwiseAbs().maxCoeff();
  const double error = (matrix - sign * matrix.transpose()).cwiseAbs().maxCoeff();
  if (error <= kSymmetryTolerance * size) return {};
  return SuperelementFault{
      dataset, fmt::format("is not {}: differs from its transpose by {:.3g}, largest entry {:.3g}",
                           sign > 0.0 ? "symmetric" : "skew", error, size)};
}

Fault check_positive_definite(const std::string& dataset, const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (!(matrix(i, i) > 0.0)) {
      return SuperelementFault{dataset, fmt::format("has the diagonal entry {:.6g} for mode {}, expected > 0",
                                                    matrix(i, i), i + 1)};
    }
  }
  if (support::is_positive_definite(matrix)) return {};
  return SuperelementFault{dataset, "is not positive definite"};
}

Fault check_nodes(const Superelement& s) {
  const int num_nodes = s.num_nodes();
  if (num_nodes < 1) return SuperelementFault{"/nodes/id", "has no nodes"};
  std::set<std::int64_t> ids;
  for (const std::int64_t id : s.node_ids) {
    if (!ids.insert(id).second) return SuperelementFault{"/nodes/id", fmt::format("has node {} twice", id)};
  }
  if (Fault fault = check_matrix("/nodes/position", s.node_positions, 2, num_nodes)) return fault;
  std::set<std::string> names;
  for (const NamedPoint& point : s.points) {
    if (point.name.empty()) return SuperelementFault{"/points/name", "has an empty name"};
    if (!names.insert(point.name).second) {
      return SuperelementFault{"/points/name", fmt::format("has the name '{}' twice", point.name)};
    }
    if (point.node < 0 || point.node >= num_nodes) {
      return SuperelementFault{"/points/node", fmt::format("has node {} for point '{}', expected 0 … {}",
                                                           point.node, point.name, num_nodes - 1)};
    }
  }
  return {};
}

Fault check_elements(const Superelement& s) {
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e) {
    const int first = s.elements(0, e), second = s.elements(1, e);
    if (first < 0 || second < 0 || first >= s.num_nodes() || second >= s.num_nodes() || first == second) {
      return SuperelementFault{
          "/elements/node", fmt::format("has nodes {} and {} for element {}, expected two of 0 … {}", first,
                                        second, e, s.num_nodes() - 1)};
    }
  }
  const auto num_sections = static_cast<Eigen::Index>(s.element_sections.size());
  return check_size("/elements/section", num_sections, 1, s.elements.cols(), 1);
}

Fault check_modes(const Superelement& s) {
  const Eigen::Index n = s.frequency_hz.size();
  if (n < 1) return SuperelementFault{"/modes/frequency", "has no modes"};
  if (Fault fault = check_matrix("/modes/frequency", s.frequency_hz, n, 1)) return fault;
  if (Fault fault = check_matrix("/modes/damping_ratio", s.damping_ratio, n, 1)) return fault;
  if (Fault fault = check_size("/modes/cluster", s.cluster.size(), 1, n, 1)) return fault;
  if (Fault fault = check_matrix("/modes/shape", s.shapes, 3 * s.num_nodes(), n)) return fault;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(s.frequency_hz(i) > 0.0)) {
      return SuperelementFault{"/modes/frequency", fmt::format("is {:.6g} Hz for mode {}, expected > 0",
                                                               s.frequency_hz(i), i + 1)};
    }
    if (!(s.damping_ratio(i) >= 0.0)) {
      return SuperelementFault{"/modes/damping_ratio",
                               fmt::format("is {:.6g} for mode {}, expected ≥ 0", s.damping_ratio(i), i + 1)};
    }
    if (s.cluster(i) < 1 || (i > 0 && s.cluster(i) < s.cluster(i - 1))) {
      return SuperelementFault{
          "/modes/cluster",
          fmt::format("is {} for mode {}, expected ≥ 1 and never descending", s.cluster(i), i + 1)};
    }
    if (i > 0 && s.frequency_hz(i) < s.frequency_hz(i - 1) * (1.0 - kOrderTolerance)) {
      return SuperelementFault{"/modes/frequency",
                               fmt::format("falls from {:.9g} to {:.9g} Hz at mode {}", s.frequency_hz(i - 1),
                                           s.frequency_hz(i), i + 1)};
    }
  }
  if (s.num_elastic_dofs < n) {
    return SuperelementFault{
        "/", fmt::format("num_elastic_dofs is {}, expected at least the {} modes", s.num_elastic_dofs, n)};
  }
  return {};
}

Fault check_modal_matrices(const Superelement& s) {
  const Eigen::Index n = s.frequency_hz.size();
  const std::pair<const char*, const Eigen::MatrixXd*> matrices[] = {
      {"/matrices/stiffness", &s.stiffness}, {"/matrices/mass", &s.mass}, {"/matrices/damping", &s.damping}};
  for (const auto& [dataset, matrix] : matrices) {
    if (Fault fault = check_matrix(dataset, *matrix, n, n)) return fault;
    if (Fault fault = check_symmetry(dataset, *matrix, 1.0)) return fault;
  }
  if (Fault fault = check_positive_definite("/matrices/stiffness", s.stiffness)) return fault;
  return check_positive_definite("/matrices/mass", s.mass);
}

Fault check_rigid_inertia(const InertiaInvariants& inertia) {
  if (!std::isfinite(inertia.mass) || !(inertia.mass > 0.0)) {
    return SuperelementFault{"/inertia/mass", fmt::format("is {:.6g} kg, expected > 0", inertia.mass)};
  }
  if (!inertia.first_moment.allFinite()) {
    return SuperelementFault{"/inertia/first_moment", "contains NaN or infinity"};
  }
  // About the centre of mass J₀ − |S₀|²/m, which no body has below zero (but for rounding).
  const double steiner = inertia.first_moment.squaredNorm() / inertia.mass;
  if (!std::isfinite(inertia.second_moment) || !(inertia.second_moment > steiner * (1.0 - 1e-12)) ||
      !(inertia.second_moment > 0.0)) {
    return SuperelementFault{
        "/inertia/second_moment",
        fmt::format("is {:.6g} kg·m², expected > 0 and at least |first moment|²/mass = {:.6g}",
                    inertia.second_moment, steiner)};
  }
  return {};
}

Fault check_inertia(const InertiaInvariants& inertia, Eigen::Index n) {
  if (Fault fault = check_rigid_inertia(inertia)) return fault;
  if (Fault fault = check_matrix("/inertia/P", inertia.P, 2, n)) return fault;
  const std::pair<const char*, const Eigen::RowVectorXd*> rows[] = {{"/inertia/c", &inertia.c},
                                                                    {"/inertia/d", &inertia.d},
                                                                    {"/inertia/x_phi_x", &inertia.x_phi_x},
                                                                    {"/inertia/x_phi_y", &inertia.x_phi_y},
                                                                    {"/inertia/y_phi_x", &inertia.y_phi_x},
                                                                    {"/inertia/y_phi_y", &inertia.y_phi_y}};
  for (const auto& [dataset, row] : rows) {
    if (Fault fault = check_matrix(dataset, *row, 1, n)) return fault;
  }
  const std::pair<const char*, const Eigen::MatrixXd*> matrices[] = {
      {"/inertia/M_ff", &inertia.M_ff},
      {"/inertia/B", &inertia.B},
      {"/inertia/phi_x_phi_x", &inertia.phi_x_phi_x},
      {"/inertia/phi_x_phi_y", &inertia.phi_x_phi_y},
      {"/inertia/phi_y_phi_y", &inertia.phi_y_phi_y}};
  for (const auto& [dataset, matrix] : matrices) {
    if (Fault fault = check_matrix(dataset, *matrix, n, n)) return fault;
  }
  if (Fault fault = check_symmetry("/inertia/M_ff", inertia.M_ff, 1.0)) return fault;
  if (Fault fault = check_symmetry("/inertia/phi_x_phi_x", inertia.phi_x_phi_x, 1.0)) return fault;
  if (Fault fault = check_symmetry("/inertia/phi_y_phi_y", inertia.phi_y_phi_y, 1.0)) return fault;
  if (Fault fault = check_symmetry("/inertia/B", inertia.B, -1.0)) return fault;
  return check_positive_definite("/inertia/M_ff", inertia.M_ff);
}

Fault check_symmetric(const std::string& dataset, const Eigen::MatrixXd& matrix, Eigen::Index size) {
  if (Fault fault = check_matrix(dataset, matrix, size, size)) return fault;
  return check_symmetry(dataset, matrix, 1.0);
}

Fault check_geometric_stiffness(const Superelement& s) {
  const GeometricStiffness& geometric = *s.geometric_stiffness;
  const Eigen::Index m = geometric.num_modes();
  if (m < 1 || m > s.num_modes()) {
    return SuperelementFault{"/stiffening/centrifugal",
                             fmt::format("is of {} modes, expected 1 … {}", m, s.num_modes())};
  }
  if (Fault fault = check_symmetric("/stiffening/centrifugal", geometric.centrifugal, m)) return fault;
  if (Fault fault = check_symmetric("/stiffening/angular_acceleration", geometric.angular_acceleration, m)) {
    return fault;
  }
  for (const Eigen::MatrixXd& K : geometric.acceleration) {
    if (Fault fault = check_symmetric("/stiffening/acceleration", K, m)) return fault;
  }
  if (geometric.point_loads.size() != s.points.size()) {
    return SuperelementFault{
        "/stiffening/point_load",
        fmt::format("is of {} points, expected {}", geometric.point_loads.size(), s.points.size())};
  }
  for (const auto& loads : geometric.point_loads) {
    for (const Eigen::MatrixXd& K : loads) {
      if (Fault fault = check_symmetric("/stiffening/point_load", K, m)) return fault;
    }
  }
  return {};
}

Fault check_provenance(const Superelement& s) {
  if (s.provenance.input_names.size() != s.provenance.input_hashes.size()) {
    return SuperelementFault{"/provenance/input_hash",
                             fmt::format("has {} hashes for {} names", s.provenance.input_hashes.size(),
                                         s.provenance.input_names.size())};
  }
  for (const CheckResult& check : s.checks) {
    if (!std::isfinite(check.value) || !std::isfinite(check.tolerance)) {
      return SuperelementFault{"/checks/value",
                               fmt::format("or tolerance is not finite for '{}'", check.name)};
    }
  }
  return {};
}

}  // namespace

std::optional<SuperelementFault> find_fault(const Superelement& superelement) {
  if (superelement.name.empty()) return SuperelementFault{"/", "attribute 'name' is empty"};
  if (Fault fault = check_nodes(superelement)) return fault;
  if (Fault fault = check_elements(superelement)) return fault;
  if (Fault fault = check_modes(superelement)) return fault;
  if (Fault fault = check_modal_matrices(superelement)) return fault;
  if (Fault fault = check_inertia(superelement.inertia, superelement.frequency_hz.size())) return fault;
  if (Fault fault = check_matrix("/resultants", superelement.resultants, 6 * superelement.elements.cols(),
                                 superelement.frequency_hz.size())) {
    return fault;
  }
  if (superelement.geometric_stiffness) {
    if (Fault fault = check_geometric_stiffness(superelement)) return fault;
  }
  return check_provenance(superelement);
}

}  // namespace sprung::reduce

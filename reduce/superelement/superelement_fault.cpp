#include "reduce/superelement/superelement_fault.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "tools/support/dense/dense_solvers.h"

namespace sprung::reduce {

namespace {

using Fault = std::optional<SuperelementFault>;
using support::RowMatrix;

// Modal matrices are symmetrised before they are written: what is left is a file that somebody else made.
constexpr double kSymmetryTolerance = 1e-12;
// Modes of equal frequency may stand in any order (relative gap of a cluster; reduce, "One basis").
constexpr double kOrderTolerance = 1e-6;

template <typename... Arguments>
Fault make_fault(std::string_view dataset, fmt::format_string<Arguments...> format,
                 Arguments&&... arguments) {
  return SuperelementFault{std::string(dataset), fmt::format(format, std::forward<Arguments>(arguments)...)};
}

// As allFinite, which is several times slower: 0 x is NaN of NaN and of infinity.
bool is_finite(const RowMatrix& matrix) {
  return (0.0 * matrix.array()).sum() == 0.0;
}

// sign +1: symmetric, −1: skew.
Fault check_symmetry(std::string_view dataset, const RowMatrix& matrix, double sign) {
  if (matrix.size() == 0) return {};
  const double size = matrix.cwiseAbs().maxCoeff();
  const double error = (matrix - sign * matrix.transpose()).cwiseAbs().maxCoeff();
  if (error <= kSymmetryTolerance * size) return {};
  return make_fault(dataset, "is not {}: differs from its transpose by {:.3g}, largest entry {:.3g}",
                    sign > 0.0 ? "symmetric" : "skew", error, size);
}

Fault check_positive_definite(std::string_view dataset, const RowMatrix& matrix) {
  if (Fault fault = check_symmetry(dataset, matrix, 1.0)) return fault;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (!(matrix(i, i) > 0.0)) {
      return make_fault(dataset, "has the diagonal entry {:.6g} for mode {}, expected > 0", matrix(i, i),
                        i + 1);
    }
  }
  if (support::is_positive_definite(matrix)) return {};
  return make_fault(dataset, "is not positive definite");
}

Fault check_sign(const SuperelementField& field, const RowMatrix& values) {
  const bool zero_fits = field.rule == FieldRule::kNotNegative;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const double value = values(i);
    if (value > 0.0 || (zero_fits && value == 0.0)) continue;
    const std::string unit = field.unit == "1" ? "" : fmt::format(" {}", field.unit);
    const std::string mode = field.shape == "n" ? fmt::format(" for mode {}", i + 1) : "";
    return make_fault(field.path, "is {:.6g}{}{}, expected {} 0", value, unit, mode, zero_fits ? "≥" : ">");
  }
  return {};
}

Fault check_matrix(const SuperelementField& field, const RowMatrix& matrix, Eigen::Index rows,
                   Eigen::Index columns) {
  if (matrix.rows() == 1 && columns == 1) std::swap(rows, columns);  // the struct has some vectors as rows
  if (matrix.rows() != rows || matrix.cols() != columns) {
    return make_fault(field.path, "has {}×{} values, expected {}×{}", matrix.rows(), matrix.cols(), rows,
                      columns);
  }
  if (!is_finite(matrix)) return make_fault(field.path, "contains NaN or infinity");
  switch (field.rule) {
    case FieldRule::kPositive:
    case FieldRule::kNotNegative:
      return check_sign(field, matrix);
    case FieldRule::kSymmetric:
      return check_symmetry(field.path, matrix, 1.0);
    case FieldRule::kSkew:
      return check_symmetry(field.path, matrix, -1.0);
    case FieldRule::kPositiveDefinite:
      return check_positive_definite(field.path, matrix);
    default:
      return {};
  }
}

Fault check_field(const SuperelementField& field, const FieldValue& value,
                  const std::vector<std::int64_t>& extents) {
  const auto [num_matrices, rows, columns] = calc_matrices(field, extents);
  for (const RowMatrix& matrix : value.matrices()) {
    if (Fault fault = check_matrix(field, matrix, rows, columns)) return fault;
  }
  const bool is_list = field.type == FieldType::kIntegers || field.type == FieldType::kTexts;
  const std::size_t size = value.matrices().size() + value.integers.size() + value.texts.size();
  const auto expected = static_cast<std::size_t>(is_list ? rows * columns : num_matrices);
  if (size == expected) return {};
  return make_fault(field.path, "has {} values, expected {}", size, expected);
}

// The counts that shapes are made of.
Fault check_counts(const Superelement& s) {
  if (s.num_nodes() < 1) return make_fault("/nodes/id", "has no nodes");
  if (s.num_modes() < 1) return make_fault("/modes/frequency", "has no modes");
  if (!s.kind.empty() && !s.certificate) return make_fault("/modes/kind", "stands without a certificate");
  if (s.certificate && !s.geometric_stiffness) {
    return make_fault("/certificate", "stands without the geometric stiffness of version 2");
  }
  if (s.section_loads && !s.certificate) {
    return make_fault("/section_loads", "stands without the certificate of version 3");
  }
  if (s.section_loads.has_value() != s.point_deflections.has_value()) {
    return s.section_loads ? make_fault("/section_loads", "stands without the deflections")
                           : make_fault("/deflections", "stands without the section loads");
  }
  if (s.section_sizes && !s.section_loads) {
    return make_fault("/sections", "stands without the section loads of version 4");
  }
  if (s.section_loads && !s.section_sizes && find_version(s) >= kSoftReferenceVersion) {
    return make_fault("/section_loads", "stands without the sizes of sections of version 5");
  }
  if (!s.geometric_stiffness) return {};
  const int m = s.geometric_stiffness->num_modes();
  const int smallest = s.elements.cols() > 0 ? 1 : 0;  // that of a body from matrices is not known
  if (m < smallest || m > s.num_modes()) {
    return make_fault("/stiffening/centrifugal", "is of {} modes, expected {} … {}", m, smallest,
                      s.num_modes());
  }
  const std::size_t num_points = s.geometric_stiffness->point_loads.size();
  if (num_points == s.points.size()) return {};
  return make_fault("/stiffening/point_load", "is of {} points, expected {}", num_points, s.points.size());
}

Fault check_nodes(const Superelement& s) {
  std::set<std::int64_t> ids;
  for (const std::int64_t id : s.node_ids) {
    if (!ids.insert(id).second) return make_fault("/nodes/id", "has node {} twice", id);
  }
  std::set<std::string> names;
  for (const NamedPoint& point : s.points) {
    if (point.name.empty()) return make_fault("/points/name", "has an empty name");
    if (!names.insert(point.name).second) {
      return make_fault("/points/name", "has the name '{}' twice", point.name);
    }
    if (point.node < 0 || point.node >= s.num_nodes()) {
      return make_fault("/points/node", "has node {} for point '{}', expected 0 … {}", point.node, point.name,
                        s.num_nodes() - 1);
    }
  }
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e) {
    const int first = s.elements(0, e), second = s.elements(1, e);
    if (first < 0 || second < 0 || first >= s.num_nodes() || second >= s.num_nodes() || first == second) {
      return make_fault("/elements/node", "has nodes {} and {} for element {}, expected two of 0 … {}", first,
                        second, e, s.num_nodes() - 1);
    }
  }
  return {};
}

Fault check_modes(const Superelement& s) {
  for (Eigen::Index i = 0; i < s.num_modes(); ++i) {
    if (s.cluster(i) < 1 || (i > 0 && s.cluster(i) < s.cluster(i - 1))) {
      return make_fault("/modes/cluster", "is {} for mode {}, expected ≥ 1 and never descending",
                        s.cluster(i), i + 1);
    }
    if (i > 0 && s.frequency_hz(i) < s.frequency_hz(i - 1) * (1.0 - kOrderTolerance)) {
      return make_fault("/modes/frequency", "falls from {:.9g} to {:.9g} Hz at mode {}",
                        s.frequency_hz(i - 1), s.frequency_hz(i), i + 1);
    }
  }
  if (s.num_elastic_dofs >= s.num_modes()) return {};
  return make_fault("/", "num_elastic_dofs is {}, expected at least the {} modes", s.num_elastic_dofs,
                    s.num_modes());
}

Fault check_certificate(const Superelement& s) {
  static const std::set<std::string> kKinds{kFreeVector, kResidualVector, kClampedVector,
                                            kFixedInterfaceVector, kConstraintVector};
  for (std::size_t i = 0; i < s.kind.size(); ++i) {
    if (kKinds.count(s.kind[i]) == 0) {
      return make_fault(
          "/modes/kind",
          "is '{}' for mode {}, expected free, residual, clamped, fixed-interface or constraint", s.kind[i],
          i + 1);
    }
  }
  if (!s.certificate) return {};
  for (const InterfaceError& one : s.certificate->interface) {
    if (one.point >= static_cast<int>(s.points.size())) {
      return make_fault("/certificate/interface_point", "is {}, expected 0 … {}", one.point,
                        static_cast<int>(s.points.size()) - 1);
    }
    if (one.freedom > 2) {
      return make_fault("/certificate/interface_freedom", "is {}, expected 0, 1 or 2", one.freedom);
    }
  }
  for (const double share : s.certificate->soft_static_share) {
    if (share > 1.0) return make_fault("/certificate/soft_static_share", "is {}, expected 0 … 1", share);
  }
  return {};
}

// About the centre of mass J₀ − |S₀|²/m, which no body has below zero (but for rounding).
Fault check_second_moment(const InertiaInvariants& inertia) {
  const double steiner = inertia.first_moment.squaredNorm() / inertia.mass;
  if (inertia.second_moment > 0.0 && inertia.second_moment > steiner * (1.0 - 1e-12)) return {};
  return make_fault("/inertia/second_moment",
                    "is {:.6g} kg·m², expected > 0 and at least |first moment|²/mass = {:.6g}",
                    inertia.second_moment, steiner);
}

}  // namespace

std::optional<SuperelementFault> find_fault(const Superelement& superelement) {
  FieldValues values;
  return find_fault(superelement, values);
}

std::optional<SuperelementFault> find_fault(const Superelement& superelement, FieldValues& values) {
  values.clear();
  if (superelement.name.empty()) return make_fault("/", "attribute 'name' is empty");
  if (Fault fault = check_counts(superelement)) return fault;
  const FieldCounts counts = count_parts(superelement);
  values = get_values(superelement);
  auto value = values.begin();
  for (const SuperelementField& field : superelement_fields(superelement)) {
    if (Fault fault = check_field(field, *value++, calc_extents(field, counts))) return fault;
  }
  if (Fault fault = check_nodes(superelement)) return fault;
  if (Fault fault = check_modes(superelement)) return fault;
  if (Fault fault = check_certificate(superelement)) return fault;
  return check_second_moment(superelement.inertia);
}

}  // namespace sprung::reduce

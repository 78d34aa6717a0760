#include <fmt/format.h>

#include <stdexcept>

#include "reduce/superelement/superelement.h"
#include "reduce/superelement/superelement_fault.h"
#include "reduce/superelement/superelement_hash.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::reduce {

namespace {

using support::Hdf5Writer;
using support::RowMatrix;

constexpr const char* kPerMode = "per unit modal coordinate (m·√kg)";

void write_vector(Hdf5Writer& file, const std::string& dataset, const Eigen::VectorXd& values,
                  std::string_view unit) {
  file.write(dataset, std::span<const double>(values.data(), static_cast<std::size_t>(values.size())), unit);
}

// A matrix of groups of rows as an array of rank 3: (rows / group) × group × columns.
void write_grouped(Hdf5Writer& file, const std::string& dataset, const Eigen::MatrixXd& matrix,
                   std::size_t group, std::string_view unit) {
  const RowMatrix rows = matrix;
  const auto num_rows = static_cast<std::size_t>(rows.rows());
  file.write(dataset, std::span<const double>(rows.data(), static_cast<std::size_t>(rows.size())),
             {num_rows / group, group, static_cast<std::size_t>(rows.cols())}, unit);
}

void write_body(Hdf5Writer& file, const Superelement& s) {
  file.write("/nodes/id", std::span<const std::int64_t>(s.node_ids));
  file.write("/nodes/position", s.node_positions.transpose(), "m");
  std::vector<std::string> names;
  std::vector<std::int64_t> nodes;
  for (const NamedPoint& point : s.points) {
    names.push_back(point.name);
    nodes.push_back(point.node);
  }
  file.write("/points/name", std::span<const std::string>(names));
  file.write("/points/node", std::span<const std::int64_t>(nodes));
  std::vector<std::int64_t> ends;
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e)
    ends.insert(ends.end(), {s.elements(0, e), s.elements(1, e)});
  file.write("/elements/node", std::span<const std::int64_t>(ends), {ends.size() / 2, std::size_t{2}});
  file.write("/elements/section", std::span<const std::string>(s.element_sections));
}

void write_modes(Hdf5Writer& file, const Superelement& s) {
  write_vector(file, "/modes/frequency", s.frequency_hz, "Hz");
  write_vector(file, "/modes/damping_ratio", s.damping_ratio, "1");
  const std::vector<std::int64_t> cluster(s.cluster.begin(), s.cluster.end());
  file.write("/modes/cluster", std::span<const std::int64_t>(cluster));
  write_grouped(file, "/modes/shape", s.shapes, 3, fmt::format("m, m, rad {}", kPerMode));
  file.write("/matrices/stiffness", s.stiffness, "1/s^2");
  file.write("/matrices/mass", s.mass, "1");
  file.write("/matrices/damping", s.damping, "1/s");
  write_grouped(file, "/resultants", s.resultants, 6, fmt::format("N, N, N·m {}", kPerMode));
}

void write_inertia(Hdf5Writer& file, const InertiaInvariants& inertia) {
  file.write("/inertia/mass", std::span<const double>(&inertia.mass, 1), "kg");
  write_vector(file, "/inertia/first_moment", inertia.first_moment, "kg·m");
  file.write("/inertia/second_moment", std::span<const double>(&inertia.second_moment, 1), "kg·m^2");
  file.write("/inertia/P", inertia.P, "√kg");
  write_vector(file, "/inertia/c", inertia.c.transpose(), "m·√kg");
  write_vector(file, "/inertia/d", inertia.d.transpose(), "m·√kg");
  file.write("/inertia/M_ff", inertia.M_ff, "1");
  file.write("/inertia/B", inertia.B, "1");
  write_vector(file, "/inertia/x_phi_x", inertia.x_phi_x.transpose(), "m·√kg");
  write_vector(file, "/inertia/x_phi_y", inertia.x_phi_y.transpose(), "m·√kg");
  write_vector(file, "/inertia/y_phi_x", inertia.y_phi_x.transpose(), "m·√kg");
  write_vector(file, "/inertia/y_phi_y", inertia.y_phi_y.transpose(), "m·√kg");
  file.write("/inertia/phi_x_phi_x", inertia.phi_x_phi_x, "1");
  file.write("/inertia/phi_x_phi_y", inertia.phi_x_phi_y, "1");
  file.write("/inertia/phi_y_phi_y", inertia.phi_y_phi_y, "1");
}

// Matrices of one size, m×m each, as an array of rank 3.
template <typename Matrices>
void write_matrices(Hdf5Writer& file, const std::string& dataset, const Matrices& matrices, Eigen::Index m,
                    std::string_view unit) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(matrices.size()) * m, m);
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    rows.middleRows(static_cast<Eigen::Index>(i) * m, m) = matrices[i];
  }
  write_grouped(file, dataset, rows, static_cast<std::size_t>(m), unit);
}

void write_geometric_stiffness(Hdf5Writer& file, const GeometricStiffness& geometric) {
  const Eigen::Index m = geometric.num_modes();
  file.write("/stiffening/centrifugal", geometric.centrifugal, "1");
  file.write("/stiffening/angular_acceleration", geometric.angular_acceleration, "1");
  write_matrices(file, "/stiffening/acceleration", geometric.acceleration, m, "1/m");
  std::vector<Eigen::MatrixXd> loads;
  for (const auto& of_point : geometric.point_loads)
    loads.insert(loads.end(), of_point.begin(), of_point.end());
  write_matrices(file, "/stiffening/point_load", loads, m, "1/(kg·m), 1/(kg·m), 1/(kg·m^2)");
}

void write_record(Hdf5Writer& file, const Superelement& s) {
  std::vector<std::string> names;
  std::vector<double> values, tolerances;
  for (const CheckResult& check : s.checks) {
    names.push_back(check.name);
    values.push_back(check.value);
    tolerances.push_back(check.tolerance);
  }
  file.write("/checks/name", std::span<const std::string>(names));
  file.write("/checks/value", std::span<const double>(values), "1");
  file.write("/checks/tolerance", std::span<const double>(tolerances), "1");
  // Texts are datasets, not attributes: an attribute ends at 64 KiB and carries no checksum.
  file.write("/provenance/design_text", std::span<const std::string>(&s.provenance.design_text, 1));
  file.write("/provenance/design_hash", std::span<const std::string>(&s.provenance.design_hash, 1));
  file.write("/provenance/input_name", std::span<const std::string>(s.provenance.input_names));
  file.write("/provenance/input_hash", std::span<const std::string>(s.provenance.input_hashes));
  file.attribute("/provenance", "program_version", s.provenance.program_version);
  file.attribute("/provenance", "algorithm_revision", s.provenance.algorithm_revision);
}

}  // namespace

std::string write_superelement(const Superelement& superelement, const std::filesystem::path& path) {
  if (const std::optional<SuperelementFault> fault = find_fault(superelement)) {
    throw std::invalid_argument(fmt::format("write_superelement: '{}' {}", fault->dataset, fault->message));
  }
  const std::string hash = calc_content_hash(superelement);
  Hdf5Writer file(path);
  file.attribute("/", "format", std::string_view("sprung-superelement"));
  file.attribute("/", "version", superelement.geometric_stiffness ? kSuperelementVersion : std::int64_t{1});
  file.attribute("/", "units", std::string_view("SI: kg, m, s, N, rad; frequencies in Hz"));
  file.attribute("/", "name", std::string_view(superelement.name));
  file.attribute("/", "num_elastic_dofs", superelement.num_elastic_dofs);
  file.attribute("/", "content_hash", std::string_view(hash));
  write_body(file, superelement);
  write_modes(file, superelement);
  write_inertia(file, superelement.inertia);
  if (superelement.geometric_stiffness) write_geometric_stiffness(file, *superelement.geometric_stiffness);
  write_record(file, superelement);
  file.commit();
  return hash;
}

}  // namespace sprung::reduce

#include <fmt/format.h>

#include <limits>

#include "reduce/superelement/superelement.h"
#include "reduce/superelement/superelement_fault.h"
#include "reduce/superelement/superelement_hash.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::reduce {

namespace {

using support::Hdf5Reader;
using support::InputError;
using support::RowMatrix;

InputError dataset_error(const Hdf5Reader& file, const std::string& dataset, const std::string& message) {
  return InputError({.path = file.path().string()}, fmt::format("dataset '{}' {}", dataset, message));
}

// The version of the format.
std::int64_t read_version(const Hdf5Reader& file) {
  const support::SourceLocation where{.path = file.path().string()};
  if (!file.has_attribute("/", "format") || file.string_attribute("/", "format") != "sprung-superelement") {
    throw InputError(where, "not a superelement: attribute 'format' is not 'sprung-superelement'");
  }
  const std::int64_t version = file.integer_attribute("/", "version");
  if (version > kSuperelementVersion) {
    throw InputError(
        where, fmt::format("superelement format version {}, this program reads up to version {}: use a "
                           "newer sprung, or make the file again from its design with sprung-reduce build",
                           version, kSuperelementVersion));
  }
  if (version < 1)
    throw InputError(where, fmt::format("superelement format version {}, expected ≥ 1", version));
  return version;
}

std::size_t as_size(Eigen::Index value) {
  return static_cast<std::size_t>(value);
}

// The rows of an array (rows / group) × group × columns, one below the other.
Eigen::MatrixXd read_grouped(const Hdf5Reader& file, const std::string& dataset, Eigen::Index rows,
                             Eigen::Index group, Eigen::Index columns) {
  const std::size_t shape[] = {as_size(rows / group), as_size(group), as_size(columns)};
  const std::vector<double> values = file.array(dataset, shape);
  return Eigen::Map<const RowMatrix>(values.data(), rows, columns);
}

int read_index(const Hdf5Reader& file, const std::string& dataset, std::int64_t value) {
  if (value < 0 || value > std::numeric_limits<int>::max()) {
    throw dataset_error(file, dataset,
                        fmt::format("has the value {}, expected a number ≥ 0 that fits 31 bits", value));
  }
  return static_cast<int>(value);
}

void read_body(const Hdf5Reader& file, Superelement& s) {
  s.name = file.string_attribute("/", "name");
  s.num_elastic_dofs = file.integer_attribute("/", "num_elastic_dofs");
  s.node_ids = file.integers("/nodes/id", -1);
  s.node_positions =
      file.matrix("/nodes/position", static_cast<std::int64_t>(s.node_ids.size()), 2).transpose();
  const std::vector<std::string> names = file.strings("/points/name");
  const std::vector<std::int64_t> nodes =
      file.integers("/points/node", static_cast<std::int64_t>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    s.points.push_back({.name = names[i], .node = read_index(file, "/points/node", nodes[i])});
  }
  const std::vector<std::int64_t> ends = file.integers("/elements/node", -1, 2);
  s.elements.resize(2, static_cast<Eigen::Index>(ends.size() / 2));
  for (std::size_t i = 0; i < ends.size(); ++i) {
    s.elements(static_cast<Eigen::Index>(i % 2), static_cast<Eigen::Index>(i / 2)) =
        read_index(file, "/elements/node", ends[i]);
  }
  s.element_sections = file.strings("/elements/section");
}

void read_modes(const Hdf5Reader& file, Superelement& s) {
  s.frequency_hz = file.vector("/modes/frequency", -1);
  const Eigen::Index n = s.frequency_hz.size();
  s.damping_ratio = file.vector("/modes/damping_ratio", n);
  const std::vector<std::int64_t> cluster = file.integers("/modes/cluster", n);
  s.cluster.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) s.cluster(i) = read_index(file, "/modes/cluster", cluster[as_size(i)]);
  s.shapes = read_grouped(file, "/modes/shape", 3 * s.num_nodes(), 3, n);
  s.stiffness = file.matrix("/matrices/stiffness", n, n);
  s.mass = file.matrix("/matrices/mass", n, n);
  s.damping = file.matrix("/matrices/damping", n, n);
  s.resultants = read_grouped(file, "/resultants", 6 * s.elements.cols(), 6, n);
}

void read_inertia(const Hdf5Reader& file, Eigen::Index n, InertiaInvariants& inertia) {
  inertia.mass = file.vector("/inertia/mass", 1)(0);
  inertia.first_moment = file.vector("/inertia/first_moment", 2);
  inertia.second_moment = file.vector("/inertia/second_moment", 1)(0);
  inertia.P = file.matrix("/inertia/P", 2, n);
  inertia.c = file.vector("/inertia/c", n).transpose();
  inertia.d = file.vector("/inertia/d", n).transpose();
  inertia.M_ff = file.matrix("/inertia/M_ff", n, n);
  inertia.B = file.matrix("/inertia/B", n, n);
  inertia.x_phi_x = file.vector("/inertia/x_phi_x", n).transpose();
  inertia.x_phi_y = file.vector("/inertia/x_phi_y", n).transpose();
  inertia.y_phi_x = file.vector("/inertia/y_phi_x", n).transpose();
  inertia.y_phi_y = file.vector("/inertia/y_phi_y", n).transpose();
  inertia.phi_x_phi_x = file.matrix("/inertia/phi_x_phi_x", n, n);
  inertia.phi_x_phi_y = file.matrix("/inertia/phi_x_phi_y", n, n);
  inertia.phi_y_phi_y = file.matrix("/inertia/phi_y_phi_y", n, n);
}

GeometricStiffness read_geometric_stiffness(const Hdf5Reader& file, std::size_t num_points) {
  GeometricStiffness geometric;
  geometric.centrifugal = file.matrix("/stiffening/centrifugal", -1, -1);
  const Eigen::Index m = geometric.centrifugal.rows();
  geometric.angular_acceleration = file.matrix("/stiffening/angular_acceleration", m, m);
  const Eigen::MatrixXd accelerations = read_grouped(file, "/stiffening/acceleration", 2 * m, m, m);
  geometric.acceleration = {accelerations.topRows(m), accelerations.bottomRows(m)};
  const auto num_loads = 3 * static_cast<Eigen::Index>(num_points);
  const Eigen::MatrixXd loads = read_grouped(file, "/stiffening/point_load", num_loads * m, m, m);
  for (Eigen::Index first = 0; first < num_loads * m; first += 3 * m) {
    geometric.point_loads.push_back(
        {loads.middleRows(first, m), loads.middleRows(first + m, m), loads.middleRows(first + 2 * m, m)});
  }
  return geometric;
}

std::string read_single_string(const Hdf5Reader& file, const std::string& dataset) {
  const std::vector<std::string> texts = file.strings(dataset);
  if (texts.size() == 1) return texts.front();
  throw dataset_error(file, dataset, fmt::format("has {} texts, expected 1", texts.size()));
}

void read_record(const Hdf5Reader& file, Superelement& s) {
  const std::vector<std::string> names = file.strings("/checks/name");
  const auto num_checks = static_cast<std::int64_t>(names.size());
  const Eigen::VectorXd values = file.vector("/checks/value", num_checks);
  const Eigen::VectorXd tolerances = file.vector("/checks/tolerance", num_checks);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    s.checks.push_back({.name = names[as_size(i)], .value = values(i), .tolerance = tolerances(i)});
  }
  s.provenance.design_text = read_single_string(file, "/provenance/design_text");
  s.provenance.design_hash = read_single_string(file, "/provenance/design_hash");
  s.provenance.input_names = file.strings("/provenance/input_name");
  s.provenance.input_hashes = file.strings("/provenance/input_hash");
  s.provenance.program_version = file.string_attribute("/provenance", "program_version");
  s.provenance.algorithm_revision = file.integer_attribute("/provenance", "algorithm_revision");
}

}  // namespace

Superelement read_superelement(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const std::int64_t version = read_version(file);
  Superelement s;
  read_body(file, s);
  read_modes(file, s);
  read_inertia(file, s.frequency_hz.size(), s.inertia);
  if (version >= 2) s.geometric_stiffness = read_geometric_stiffness(file, s.points.size());
  read_record(file, s);
  if (const std::optional<SuperelementFault> fault = find_fault(s)) {
    throw dataset_error(file, fault->dataset, fault->message);
  }
  s.content_hash = file.string_attribute("/", "content_hash");
  if (const std::string hash = calc_content_hash(s); hash != s.content_hash) {
    throw InputError(
        {.path = path.string()},
        fmt::format("attribute 'content_hash' is {}, but the contents have the hash {}: the file was "
                    "changed after it was written",
                    s.content_hash, hash));
  }
  return s;
}

}  // namespace sprung::reduce

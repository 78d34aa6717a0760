#include "reduce/superelement/superelement_hash.h"

#include <fmt/format.h>

#include "tools/support/files/content_hash.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::reduce {

namespace {

using support::ContentHash;
using support::RowMatrix;

void add(ContentHash& hash, const std::string& label, const Eigen::MatrixXd& matrix) {
  const RowMatrix rows = matrix;
  hash.add(label + fmt::format(" {}x{}", rows.rows(), rows.cols()),
           std::span<const double>(rows.data(), static_cast<std::size_t>(rows.size())));
}

void add(ContentHash& hash, const std::string& label, const std::vector<std::string>& texts) {
  hash.add(label, fmt::format("{}", texts.size()));
  for (const std::string& text : texts) hash.add(label, text);
}

void add(ContentHash& hash, const std::string& label, std::int64_t value) {
  hash.add(label, std::span<const std::int64_t>(&value, 1));
}

void add_body(ContentHash& hash, const Superelement& s) {
  hash.add("name", s.name);
  add(hash, "num_elastic_dofs", s.num_elastic_dofs);
  hash.add("/nodes/id", std::span<const std::int64_t>(s.node_ids));
  add(hash, "/nodes/position", s.node_positions.transpose());
  for (const NamedPoint& point : s.points) {
    hash.add("/points/name", point.name);
    add(hash, "/points/node", point.node);
  }
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e) {
    const std::int64_t ends[] = {s.elements(0, e), s.elements(1, e)};
    hash.add("/elements/node", std::span<const std::int64_t>(ends));
  }
  add(hash, "/elements/section", s.element_sections);
}

void add_modes(ContentHash& hash, const Superelement& s) {
  add(hash, "/modes/frequency", s.frequency_hz);
  add(hash, "/modes/damping_ratio", s.damping_ratio);
  for (Eigen::Index i = 0; i < s.cluster.size(); ++i) add(hash, "/modes/cluster", s.cluster(i));
  add(hash, "/modes/shape", s.shapes);
  add(hash, "/matrices/stiffness", s.stiffness);
  add(hash, "/matrices/mass", s.mass);
  add(hash, "/matrices/damping", s.damping);
  add(hash, "/resultants", s.resultants);
}

void add_inertia(ContentHash& hash, const InertiaInvariants& inertia) {
  const double rigid[] = {inertia.mass, inertia.first_moment.x(), inertia.first_moment.y(),
                          inertia.second_moment};
  hash.add("/inertia/rigid", std::span<const double>(rigid));
  add(hash, "/inertia/P", inertia.P);
  add(hash, "/inertia/c", inertia.c);
  add(hash, "/inertia/d", inertia.d);
  add(hash, "/inertia/M_ff", inertia.M_ff);
  add(hash, "/inertia/B", inertia.B);
  add(hash, "/inertia/x_phi_x", inertia.x_phi_x);
  add(hash, "/inertia/x_phi_y", inertia.x_phi_y);
  add(hash, "/inertia/y_phi_x", inertia.y_phi_x);
  add(hash, "/inertia/y_phi_y", inertia.y_phi_y);
  add(hash, "/inertia/phi_x_phi_x", inertia.phi_x_phi_x);
  add(hash, "/inertia/phi_x_phi_y", inertia.phi_x_phi_y);
  add(hash, "/inertia/phi_y_phi_y", inertia.phi_y_phi_y);
}

void add_geometric_stiffness(ContentHash& hash, const GeometricStiffness& geometric) {
  add(hash, "/stiffening/centrifugal", geometric.centrifugal);
  add(hash, "/stiffening/angular_acceleration", geometric.angular_acceleration);
  for (const Eigen::MatrixXd& K : geometric.acceleration) add(hash, "/stiffening/acceleration", K);
  for (const auto& loads : geometric.point_loads) {
    for (const Eigen::MatrixXd& K : loads) add(hash, "/stiffening/point_load", K);
  }
}

void add_record(ContentHash& hash, const Superelement& s) {
  for (const CheckResult& check : s.checks) {
    const double numbers[] = {check.value, check.tolerance};
    hash.add("/checks/name", check.name);
    hash.add("/checks/value", std::span<const double>(numbers));
  }
  hash.add("/provenance/design_text", s.provenance.design_text);
  hash.add("/provenance/design_hash", s.provenance.design_hash);
  add(hash, "/provenance/input_name", s.provenance.input_names);
  add(hash, "/provenance/input_hash", s.provenance.input_hashes);
  hash.add("program_version", s.provenance.program_version);
  add(hash, "algorithm_revision", s.provenance.algorithm_revision);
}

}  // namespace

std::string calc_content_hash(const Superelement& superelement) {
  ContentHash hash;
  add_body(hash, superelement);
  add_modes(hash, superelement);
  add_inertia(hash, superelement.inertia);
  if (superelement.geometric_stiffness) add_geometric_stiffness(hash, *superelement.geometric_stiffness);
  add_record(hash, superelement);
  return hash.hex();
}

}  // namespace sprung::reduce

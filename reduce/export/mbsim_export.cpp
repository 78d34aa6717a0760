#include "reduce/export/mbsim_export.h"

#include <fmt/format.h>

#include <limits>

#include "reduce/export/spatial_integrals.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/exchange_file.h"

namespace sprung::reduce {

namespace {

std::vector<std::int32_t> convert_node_numbers(const Superelement& s, const std::string& path) {
  std::vector<std::int32_t> numbers;
  for (const std::int64_t id : s.node_ids) {
    if (id > std::numeric_limits<std::int32_t>::max()) {
      throw support::InputError({.path = path},
                                fmt::format("node {} has a number beyond the 31 bits that MBSim reads", id));
    }
    numbers.push_back(static_cast<std::int32_t>(id));
  }
  return numbers;
}

// Rows 3k + i: ∫r_k φ_i dm. The part of c that rotary inertia causes is divided between two of them.
Eigen::MatrixXd calc_position_products(const InertiaInvariants& inertia) {
  const Eigen::RowVectorXd rotary = inertia.c - (inertia.x_phi_y - inertia.y_phi_x);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(9, inertia.P.cols());
  products.row(0) = inertia.x_phi_x;
  products.row(1) = inertia.x_phi_y + 0.5 * rotary;
  products.row(3) = inertia.y_phi_x - 0.5 * rotary;
  products.row(4) = inertia.y_phi_y;
  return products;
}

// Blocks xx, xy, xz, yy, yz, zz of ∫φ_i φ_j dm. Rotary inertia counts as motion along z.
Eigen::MatrixXd calc_shape_products(const InertiaInvariants& inertia) {
  const Eigen::Index n = inertia.P.cols();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(6 * n, n);
  products.middleRows(0, n) = inertia.phi_x_phi_x;
  products.middleRows(n, n) = inertia.phi_x_phi_y;
  products.middleRows(3 * n, n) = inertia.phi_y_phi_y;
  products.middleRows(5 * n, n) = inertia.M_ff - inertia.phi_x_phi_x - inertia.phi_y_phi_y;
  return products;
}

}  // namespace

ExportReport export_mbsim(const Superelement& s, const std::string& prefix) {
  const std::string path = prefix + "_mbsim.h5";  // PREFIX.h5 may be the superelement itself
  const std::vector<std::int32_t> numbers = convert_node_numbers(s, path);
  const InertiaInvariants& inertia = s.inertia;
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3, s.num_modes());
  P.topRows(2) = inertia.P;
  support::ExchangeFile file(path);
  file.write_number("mass", inertia.mass);
  file.write_vector("position integral",
                    Eigen::Vector3d(inertia.first_moment.x(), inertia.first_moment.y(), 0.0));
  file.write_matrix(
      "position position integral",
      0.5 * inertia.second_moment * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal().toDenseMatrix());
  file.write_matrix("shape function integral", P);
  file.write_matrix("position shape function integral", calc_position_products(inertia));
  file.write_matrix("shape function shape function integral", calc_shape_products(inertia));
  file.write_matrix("stiffness matrix", s.stiffness);
  file.write_matrix("damping matrix", s.damping);
  file.write_vector("nodal relative position", expand_positions(s));
  file.write_matrix("nodal shape matrix of translation", expand_displacements(s));
  file.write_matrix("nodal shape matrix of rotation", expand_rotations(s));
  file.write_integers("node numbers", numbers);
  file.commit();
  return {
      .paths = {path},
      .left_out = {"moments of inertia about x and y, and rotary inertia out of the plane: a body in the "
                   "plane has none, use the file for motion in the plane",
                   "geometric stiffness, section loads (no nodal stress matrix), deflections under loads and "
                   "the certificate"}};
}

}  // namespace sprung::reduce

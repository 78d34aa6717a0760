#include "reduce/reduction/inertia_invariants.h"

#include <fmt/format.h>

#include <stdexcept>

#include "reduce/factors/tall_products.h"

namespace sprung::reduce {

namespace {

Eigen::MatrixXd symmetrise(const Eigen::MatrixXd& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

}  // namespace

InertiaInvariants calc_inertia_invariants(const fem::MassMoments& moments, const Eigen::MatrixXd& shapes) {
  if (shapes.rows() != moments.N_x.size()) {
    throw std::invalid_argument(fmt::format("calc_inertia_invariants: shapes has {} rows, expected {}",
                                            shapes.rows(), moments.N_x.size()));
  }
  InertiaInvariants inertia;
  inertia.mass = moments.mass;
  inertia.first_moment = moments.first_moment;
  inertia.second_moment = moments.second_moment();
  inertia.P.resize(2, shapes.cols());
  inertia.P.row(0) = moments.N_x.transpose() * shapes;
  inertia.P.row(1) = moments.N_y.transpose() * shapes;
  inertia.x_phi_x = moments.x_N_x.transpose() * shapes;
  inertia.x_phi_y = moments.x_N_y.transpose() * shapes;
  inertia.y_phi_x = moments.y_N_x.transpose() * shapes;
  inertia.y_phi_y = moments.y_N_y.transpose() * shapes;
  inertia.c = inertia.x_phi_y - inertia.y_phi_x + moments.rotary_N.transpose() * shapes;
  inertia.d = inertia.x_phi_x + inertia.y_phi_y;
  inertia.phi_x_phi_x = symmetrise(project(moments.NxNx, shapes));
  inertia.phi_x_phi_y = project(moments.NxNy, shapes);
  inertia.phi_y_phi_y = symmetrise(project(moments.NyNy, shapes));
  inertia.M_ff = inertia.phi_x_phi_x + inertia.phi_y_phi_y + symmetrise(project(moments.rotary_NN, shapes));
  inertia.B = inertia.phi_x_phi_y - inertia.phi_x_phi_y.transpose();
  return inertia;
}

Eigen::MatrixXd calc_mass_matrix(const InertiaInvariants& inertia) {
  const Eigen::Index n = inertia.P.cols();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(3 + n, 3 + n);
  mass(0, 0) = mass(1, 1) = inertia.mass;
  mass(0, 2) = -inertia.first_moment.y();
  mass(1, 2) = inertia.first_moment.x();
  mass(2, 2) = inertia.second_moment;
  mass.block(0, 3, 2, n) = inertia.P;
  mass.block(2, 3, 1, n) = inertia.c;
  mass.bottomRightCorner(n, n) = inertia.M_ff;
  return mass.selfadjointView<Eigen::Upper>();
}

}  // namespace sprung::reduce

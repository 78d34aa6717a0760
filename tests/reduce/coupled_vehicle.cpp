#include "tests/reduce/coupled_vehicle.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/assembly.h"
#include "reduce/reduction/inertia_invariants.h"

namespace sprung::reduce::testing {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Eigen::Matrix3d make_rigid_motion(const Eigen::Vector2d& r) {
  Eigen::Matrix3d motion;
  motion << 1, 0, -r.y(), 0, 1, r.x(), 0, 0, 1;
  return motion;
}

}  // namespace

CoupledBody make_full_body(const fem::BeamModel& model, const std::vector<InterfaceFreedom>& interface) {
  const fem::AssembledMatrices matrices = fem::assemble(model);
  return {.stiffness = matrices.stiffness,
          .mass = matrices.mass,
          .motion = make_interface_loads(model.mesh.num_nodes(), interface).transpose()};
}

CoupledBody make_reduced_body(const Superelement& s, const std::vector<InterfaceFreedom>& interface) {
  const Eigen::Index n = s.num_modes();
  CoupledBody body{.stiffness = Eigen::MatrixXd::Zero(3 + n, 3 + n),
                   .mass = calc_mass_matrix(s.inertia),
                   .motion = Eigen::MatrixXd(interface.size(), 3 + n)};
  body.stiffness.bottomRightCorner(n, n) = s.stiffness;
  for (std::size_t j = 0; j < interface.size(); ++j) {
    const auto [point, node, freedom] = interface[j];
    const auto row = static_cast<Eigen::Index>(j);
    body.motion.row(row).head(3) = make_rigid_motion(s.node_positions.col(node)).row(freedom);
    body.motion.row(row).tail(n) = s.shapes.row(3 * node + freedom);
  }
  return body;
}

CoupledVehicle make_ladder_vehicle(const LadderFrame& ladder, const CoupledBody& frame) {
  struct Rigid {
    double mass, inertia;
    Eigen::Vector2d center;
    std::vector<int> points;  // of the ladder's, in the order of its interface
  };
  const std::vector<Rigid> rigid{{800, 500, {1, 1.6}, {3, 4}},
                                 {600, 60, {1, 1.0}, {5}},
                                 {4000, 6000, {4.5, 1.6}, {6, 7}},
                                 {700, 80, {1.5, -0.3}, {0, 1}},
                                 {700, 80, {5, -0.3}, {2}}};
  constexpr double kJoint = 1e8, kTyre = 2e6;  // N/m
  const Eigen::Index n = frame.stiffness.rows(), all = n + 3 * static_cast<Eigen::Index>(rigid.size());
  CoupledVehicle vehicle{.stiffness = Eigen::MatrixXd::Zero(all, all),
                         .mass = Eigen::MatrixXd::Zero(all, all),
                         .reactions = Eigen::MatrixXd::Zero(frame.motion.rows(), all),
                         .load = Eigen::VectorXd::Unit(all, n + 3 * 3 + 1)};
  vehicle.stiffness.topLeftCorner(n, n) = frame.stiffness;
  vehicle.mass.topLeftCorner(n, n) = frame.mass;
  Eigen::MatrixXd stretch = Eigen::MatrixXd::Zero(frame.motion.rows(), all);
  stretch.leftCols(n) = frame.motion;
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    const Eigen::Index at = n + 3 * static_cast<Eigen::Index>(i);
    vehicle.mass.diagonal().segment<3>(at) << rigid[i].mass, rigid[i].mass, rigid[i].inertia;
    for (const int point : rigid[i].points) {
      const int node = ladder.interface[static_cast<std::size_t>(2 * point)].node;
      const Eigen::Vector2d r = ladder.model.mesh.node_positions.col(node) - rigid[i].center;
      stretch.block<2, 3>(2 * point, at) = -make_rigid_motion(r).topRows<2>();
    }
    if (i >= 3) vehicle.stiffness.diagonal().segment<2>(at).array() += kTyre;
  }
  vehicle.stiffness += kJoint * stretch.transpose() * stretch;
  vehicle.reactions = kJoint * stretch;
  return vehicle;
}

CoupledVehicle make_ladder_vehicle(const LadderFrame& ladder) {
  return make_ladder_vehicle(ladder, make_full_body(ladder.model, ladder.interface));
}

CoupledVehicle make_ladder_vehicle(const LadderFrame& ladder, const Superelement& superelement) {
  return make_ladder_vehicle(ladder, make_reduced_body(superelement, ladder.interface));
}

// In a basis of the null space of the constraints.
CoupledVehicle weld(const CoupledBody& first, const CoupledBody& second) {
  const Eigen::Index n = first.stiffness.rows(), m = second.stiffness.rows();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m), M = K;
  K << first.stiffness, Eigen::MatrixXd::Zero(n, m), Eigen::MatrixXd::Zero(m, n), second.stiffness;
  M << first.mass, Eigen::MatrixXd::Zero(n, m), Eigen::MatrixXd::Zero(m, n), second.mass;
  Eigen::MatrixXd constraints(first.motion.rows(), n + m);
  constraints << first.motion, -second.motion;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(constraints.transpose());
  const Eigen::MatrixXd Q = qr.householderQ();
  const Eigen::MatrixXd free = Q.rightCols(n + m - constraints.rows());
  return {.stiffness = free.transpose() * K * free,
          .mass = free.transpose() * M * free,
          .reactions = {},
          .load = {}};
}

Eigen::VectorXd calc_frequencies(const CoupledVehicle& vehicle) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(vehicle.stiffness, vehicle.mass,
                                                                         Eigen::EigenvaluesOnly);
  const Eigen::VectorXd hz = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt() / kTwoPi;
  const Eigen::Index num_rigid = (hz.array() < 0.1).count();
  return hz.tail(hz.size() - num_rigid);
}

VehicleError compare_vehicles(const CoupledVehicle& vehicle, const CoupledVehicle& truth, double highest_hz) {
  VehicleError error;
  const Eigen::VectorXd expected = calc_frequencies(truth), found = calc_frequencies(vehicle);
  for (Eigen::Index i = 0; i < expected.size() && expected(i) < highest_hz; ++i) {
    error.frequency =
        std::max(error.frequency, i < found.size() ? std::abs(found(i) / expected(i) - 1.0) : 1.0);
  }
  if (truth.load.size() == 0) return error;
  const auto respond = [](const CoupledVehicle& one, double hz) -> Eigen::VectorXcd {
    const std::complex<double> loss(1.0, 0.02);
    const Eigen::MatrixXcd dynamic = loss * one.stiffness.cast<std::complex<double>>() -
                                     (std::pow(kTwoPi * hz, 2) * one.mass).cast<std::complex<double>>();
    const Eigen::VectorXcd x = dynamic.partialPivLu().solve(one.load.cast<std::complex<double>>());
    return one.reactions * x;
  };
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(truth.reactions.rows()), differences = squares;
  for (int step = 1; step <= 60; ++step) {
    const double hz = highest_hz * step / 60.0;
    const Eigen::VectorXcd right = respond(truth, hz), other = respond(vehicle, hz);
    squares += right.cwiseAbs2();
    differences += (other - right).cwiseAbs2();
  }
  error.reaction = differences.cwiseQuotient(squares).cwiseSqrt().maxCoeff();
  return error;
}

}  // namespace sprung::reduce::testing

#include "tests/reduce/free_body_truth.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "fem/assembly.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce::testing {

FreeBodyTruth::FreeBodyTruth(const fem::BeamModel& model) {
  const fem::AssembledMatrices matrices = fem::assemble(model);
  K_ = matrices.stiffness;
  M_ = matrices.mass;
  R_ = Eigen::MatrixXd::Zero(K_.rows(), 3);
  for (Eigen::Index node = 0; node < model.mesh.node_positions.cols(); ++node) {
    const Eigen::Vector2d r = model.mesh.node_positions.col(node);
    R_.middleRows(3 * node, 3) << 1, 0, -r.y(), 0, 1, r.x(), 0, 0, 1;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K_, M_);
  omega_squared_ = solver.eigenvalues();
  shapes_ = solver.eigenvectors();
}

// [(1 + iη)K − sM, MR; RᵀM, 0] [v; μ] = [b; 0]: v has no rigid motion, and μ is the acceleration of the body.
Eigen::MatrixXcd FreeBodyTruth::calc_flexibility(double omega_squared,
                                                 const std::vector<InterfaceFreedom>& interface,
                                                 double loss_factor) const {
  const Eigen::Index n = K_.rows();
  const auto b = static_cast<Eigen::Index>(interface.size());
  const double scale = K_.diagonal().mean();  // of the three rows, so that the pivots are alike
  Eigen::MatrixXcd A = Eigen::MatrixXcd::Zero(n + 3, n + 3);
  A.topLeftCorner(n, n) = std::complex<double>(1.0, loss_factor) * K_.cast<std::complex<double>>() -
                          (omega_squared * M_).cast<std::complex<double>>();
  A.topRightCorner(n, 3) = (scale / M_.diagonal().mean() * M_ * R_).cast<std::complex<double>>();
  A.bottomLeftCorner(3, n) = A.topRightCorner(n, 3).transpose();
  Eigen::MatrixXcd load = Eigen::MatrixXcd::Zero(n + 3, b);
  load.topRows(n) = make_interface_loads(static_cast<int>(n / 3), interface).cast<std::complex<double>>();
  const Eigen::MatrixXcd response = A.partialPivLu().solve(load);
  return load.topRows(n).transpose() * response.topRows(n);
}

Eigen::MatrixXd FreeBodyTruth::calc_flexibility_at_rest(
    const std::vector<InterfaceFreedom>& interface) const {
  return calc_flexibility(0.0, interface).real();
}

Eigen::VectorXd FreeBodyTruth::calc_frequencies() const {
  return omega_squared_.tail(omega_squared_.size() - 3).cwiseSqrt() / (2.0 * std::numbers::pi);
}

bool is_resonance(const FreeBodyTruth& truth, double omega_squared) {
  return ((truth.omega_squared().array() / omega_squared - 1.0).abs() < 1e-9).any();
}

Eigen::MatrixXd calc_flexibility(const Superelement& s, double omega_squared) {
  Eigen::MatrixXd momenta(3, s.num_modes());
  momenta << s.inertia.P, s.inertia.c;
  const Eigen::Vector2d S0 = s.inertia.first_moment;
  Eigen::Matrix3d mass;
  mass << s.inertia.mass, 0, -S0.y(), 0, s.inertia.mass, S0.x(), -S0.y(), S0.x(), s.inertia.second_moment;
  const Eigen::MatrixXd rigid = mass.inverse() * momenta;
  Eigen::MatrixXd V(s.certificate->interface.size(), s.num_modes());
  for (Eigen::Index j = 0; j < V.rows(); ++j) {
    const InterfaceError& one = s.certificate->interface[static_cast<std::size_t>(j)];
    const int node = s.points[static_cast<std::size_t>(one.point)].node;
    const Eigen::Vector2d r = s.node_positions.col(node);
    Eigen::Matrix3d motion;
    motion << 1, 0, -r.y(), 0, 1, r.x(), 0, 0, 1;
    V.row(j) = s.shapes.row(3 * node + one.freedom) - motion.row(one.freedom) * rigid;
  }
  const Eigen::MatrixXd elastic = s.inertia.M_ff - momenta.transpose() * rigid;
  const Eigen::MatrixXd dynamic = s.stiffness - omega_squared * elastic;
  return V * dynamic.partialPivLu().solve(V.transpose());
}

std::vector<InterfaceFreedom> make_interface(fem::BeamModel& model, const std::vector<int>& nodes,
                                             const std::vector<int>& freedoms) {
  std::vector<InterfaceFreedom> interface;
  for (const int node : nodes) {
    const auto point = static_cast<int>(model.mesh.named_nodes.size());
    model.mesh.named_nodes.push_back({.name = fmt::format("p{}", point), .node = node});
    for (const int freedom : freedoms) interface.push_back({point, node, freedom});
  }
  return interface;
}

fem::BeamModel make_random_frame(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(generator() >> 11) * 0x1p-53;
  };
  std::vector<fem::BeamProperties> sections;
  for (int i = 0; i < 3; ++i) {
    fem::BeamProperties section = make_section(i == 2);
    section.bending_rigidity *= uniform(0.2, 5.0);
    section.mass_per_length *= uniform(0.5, 3.0);
    sections.push_back(section);
  }
  fem::BeamModel model = make_model(sections);
  const int num_corners = 4 + static_cast<int>(generator() % 4);
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < num_corners; ++i) {  // well apart, so that no two members lie on each other
    corners.emplace_back(0.9 * i + uniform(-0.2, 0.2), uniform(-0.8, 0.8));
  }
  for (int i = 1; i < num_corners; ++i)
    add_line(model, corners[i - 1], corners[i], 3, static_cast<int>(generator() % 3));
  for (int i = 2; i < num_corners; i += 2) {  // closes loops
    add_line(model, corners[i - 2], corners[i], 4, static_cast<int>(generator() % 3));
  }
  for (int i = 0; i < 2; ++i) {
    const int node = static_cast<int>(generator() % model.mesh.node_ids.size());
    model.point_masses.push_back({.node = node, .mass = uniform(0.0, 20.0), .inertia = uniform(0.0, 1.0)});
  }
  return model;
}

Design make_random_design(std::uint64_t seed, double tolerance) {
  std::mt19937_64 generator(seed + 1000);
  fem::BeamModel model = make_random_frame(seed);
  const std::size_t num_nodes = model.mesh.node_ids.size();
  std::vector<int> nodes;
  for (std::size_t i = 0; i < 2 + generator() % 3; ++i)
    nodes.push_back(static_cast<int>((generator() % num_nodes)));
  const std::vector<InterfaceFreedom> interface =
      make_interface(model, nodes, generator() % 2 == 0 ? std::vector{0, 1} : std::vector{0, 1, 2});
  const Eigen::Vector2d reference =
      model.mesh.node_positions.col(static_cast<Eigen::Index>(generator() % num_nodes));
  Design design = make_design(model, reference, {});
  const double first = FreeBodyTruth(model).calc_frequencies()(0);
  const double share = 0.3 + 0.4 * static_cast<double>(generator() % 8);
  design.reduction = {
      .basis = BasisKind::kFree, .highest_hz = share * first, .tolerance = tolerance, .interface = {}};
  for (const InterfaceFreedom& one : interface) {  // two points may have been put on one node
    bool is_new = true;
    for (const InterfaceFreedom& other : design.reduction.interface) {
      is_new = is_new && !(other.node == one.node && other.freedom == one.freedom);
    }
    if (is_new) design.reduction.interface.push_back(one);
  }
  return design;
}

LadderFrame make_ladder_frame() {
  constexpr double kYoungsModulus = 2.1e11;
  LadderFrame ladder;
  ladder.model = make_model({{.axial_rigidity = kYoungsModulus * 4.06e-3,
                              .bending_rigidity = kYoungsModulus * 1.72e-5,
                              .mass_per_length = 32.0},
                             {.axial_rigidity = kYoungsModulus * 2.12e-3,
                              .bending_rigidity = kYoungsModulus * 1.8e-6,
                              .mass_per_length = 16.6}});
  for (int bay = 0; bay < 6; ++bay) {
    for (const double y : {0.0, 0.8}) add_line(ladder.model, {bay, y}, {bay + 1.0, y}, 3, 0);
  }
  for (int post = 0; post <= 6; ++post) add_line(ladder.model, {post, 0.0}, {post, 0.8}, 3, 1);
  std::vector<int> nodes;
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(1, 0), Eigen::Vector2d(2, 0), Eigen::Vector2d(5, 0), Eigen::Vector2d(0, 0.8),
        Eigen::Vector2d(2, 0.8), Eigen::Vector2d(1, 0.8), Eigen::Vector2d(3, 0.8), Eigen::Vector2d(6, 0.8)}) {
    nodes.push_back(find_node_at(ladder.model, place));
  }
  ladder.interface = make_interface(ladder.model, nodes, {0, 1});
  ladder.reference = {3.0, 0.0};
  return ladder;
}

}  // namespace sprung::reduce::testing

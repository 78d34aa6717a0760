#include "reduce/reduction/superelement_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reduce/modes/clusters.h"
#include "reduce/reduction/element_work.h"
#include "reduce/reduction/inertia_invariants.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/dense/eigenproblems.h"

namespace sprung::reduce {

namespace {

constexpr double kFailed = 1e300;  // stands for infinity, which a file cannot hold

Eigen::VectorXd calc_omega(const Superelement& s) {
  return 2.0 * std::numbers::pi * s.frequency_hz;
}

// A matrix per ωᵢ ωⱼ.
Eigen::MatrixXd scale_by_frequencies(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& omega) {
  return omega.cwiseInverse().asDiagonal() * matrix * omega.cwiseInverse().asDiagonal();
}

// Momentum and angular momentum of the modes, and the rigid body's mass matrix, about the reference node.
struct RigidShare {
  Eigen::MatrixXd momenta;  // H, 3×n
  Eigen::Matrix3d mass;     // M_r
};

RigidShare calc_rigid_share(const InertiaInvariants& inertia) {
  const Eigen::MatrixXd mass = calc_mass_matrix(inertia);
  return {.momenta = mass.topRightCorner(3, inertia.P.cols()), .mass = mass.topLeftCorner<3, 3>()};
}

// M_ff = I of clamped modes; of the others M_ff − HᵀM_r⁻¹H = I, by the scale of M_ff (reduce/basis, eq. 3).
CheckResult check_orthogonality(const Superelement& s) {
  const Eigen::Index n = s.frequency_hz.size();
  Eigen::MatrixXd error = s.inertia.M_ff - Eigen::MatrixXd::Identity(n, n);
  if (s.has_free_basis()) {
    const RigidShare share = calc_rigid_share(s.inertia);
    error -= share.momenta.transpose() * support::solve_positive_definite(share.mass, share.momenta);
    const Eigen::VectorXd scale = s.inertia.M_ff.diagonal().cwiseSqrt().cwiseInverse();
    error = scale.asDiagonal() * error * scale.asDiagonal();
  }
  const double of_shapes = error.cwiseAbs().maxCoeff();
  const double of_matrix = (s.mass - s.inertia.M_ff).cwiseAbs().maxCoeff();
  return {.name = "orthogonality of the modes", .value = std::max(of_shapes, of_matrix), .tolerance = 1e-9};
}

// A cluster's frequencies may differ by kClusterGap from each other, and so may its block of the stiffness.
CheckResult check_stiffness(const Superelement& s, bool within_clusters) {
  const Eigen::Index n = s.frequency_hz.size();
  const Eigen::MatrixXd error =
      scale_by_frequencies(s.stiffness, calc_omega(s)) - Eigen::MatrixXd::Identity(n, n);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if ((s.cluster(i) == s.cluster(j)) == within_clusters)
        largest = std::max(largest, std::abs(error(i, j)));
    }
  }
  if (within_clusters) {
    // A cluster is a chain of gaps, so that its ends may be several gaps apart; twice for ω².
    Eigen::Index longest = 1;
    for (Eigen::Index i = 0; i < n; ++i) longest = std::max(longest, find_cluster_of(s.cluster, i).size());
    return {.name = "stiffness against frequencies",
            .value = largest,
            .tolerance = 2.0 * kClusterGap * static_cast<double>(longest)};
  }
  return {.name = "stiffness between clusters", .value = largest, .tolerance = 1e-12};
}

CheckResult check_damping(const Superelement& s) {
  const Eigen::VectorXd omega = calc_omega(s);
  const Eigen::MatrixXd expected = (2.0 * s.damping_ratio.cwiseProduct(omega)).asDiagonal();
  const Eigen::MatrixXd error = omega.cwiseSqrt().cwiseInverse().asDiagonal() * (s.damping - expected) *
                                omega.cwiseSqrt().cwiseInverse().asDiagonal();
  return {.name = "damping against ratios", .value = error.cwiseAbs().maxCoeff(), .tolerance = 1e-12};
}

// d, B and what rotary inertia must leave to M_ff and c. Scales: M_ff for n×n, which is 1 of clamped modes
// and large where the reference node is soft; √J₀ times its root for rows.
CheckResult check_components(const InertiaInvariants& inertia) {
  const Eigen::VectorXd scale = inertia.M_ff.diagonal().cwiseMax(1.0).cwiseSqrt().cwiseInverse();
  const double row_scale = std::sqrt(inertia.second_moment);
  const Eigen::RowVectorXd d_error = inertia.d - inertia.x_phi_x - inertia.y_phi_y;
  const Eigen::MatrixXd B_error = inertia.B - inertia.phi_x_phi_y + inertia.phi_x_phi_y.transpose();
  const Eigen::MatrixXd rotary =
      scale.asDiagonal() * (inertia.M_ff - inertia.phi_x_phi_x - inertia.phi_y_phi_y) * scale.asDiagonal();
  const Eigen::RowVectorXd rotary_c =
      (inertia.c - inertia.x_phi_y + inertia.y_phi_x) * scale.asDiagonal() / row_scale;
  const double indefinite = -support::calc_symmetric_eigenvalues(rotary).minCoeff();
  // Schwarz: (∫ρI ψ)² ≤ ∫ρI ∫ρI ψ², and the first integral is a part of J₀.
  const double too_large = (rotary_c.cwiseAbs2().transpose() - rotary.diagonal()).maxCoeff();
  const double of_d = (d_error * scale.asDiagonal()).cwiseAbs().maxCoeff() / row_scale;
  const double of_B = (scale.asDiagonal() * B_error * scale.asDiagonal()).cwiseAbs().maxCoeff();
  return {.name = "inertia against its components",
          .value = std::max({of_d, of_B, indefinite, too_large, 0.0}),
          .tolerance = 1e-10};
}

CheckResult check_mass_matrix(const Superelement& s) {
  const Eigen::MatrixXd mass = calc_mass_matrix(s.inertia);
  const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * mass * scale.asDiagonal();
  const Eigen::VectorXd values = support::calc_symmetric_eigenvalues(scaled);
  const double smallest = values.minCoeff();
  return {.name = kMassConditionCheck,
          .value = smallest > 0.0 ? values.maxCoeff() / smallest : kFailed,
          .tolerance = 1e10};
}

CheckResult check_held_node(const Superelement& s) {
  Eigen::Index node = 0;
  const double distance = s.node_positions.colwise().norm().minCoeff(&node);
  const double radius = s.node_positions.colwise().norm().maxCoeff();
  const double motion =
      s.shapes.middleRows(3 * node, 3).cwiseAbs().maxCoeff() / s.shapes.cwiseAbs().maxCoeff();
  return {.name = "modes at the reference node",
          .value = std::max(radius > 0.0 ? distance / radius : kFailed, motion),
          .tolerance = 1e-12};
}

double find_recorded(const Superelement& s, const char* name) {
  for (const CheckResult& check : s.checks) {
    if (check.name == name) return check.value;
  }
  return 0.0;
}

double find_rounding(const Superelement& s) {
  return std::max(find_recorded(s, kRoundingCheck), find_recorded(s, kOldRoundingCheck));
}

CheckResult check_work(const Superelement& s) {
  const ElementWork work = calc_element_work(s);
  const Eigen::MatrixXd error = scale_by_frequencies(work.axial + work.bending - s.stiffness, calc_omega(s));
  return {.name = "work of the resultants against stiffness",
          .value = error.cwiseAbs().maxCoeff(),
          .tolerance = 1e-9 + 100.0 * find_rounding(s)};
}

// The static flexibility that the vectors have at the interface, against the certificate's
// (reduce/certificate, eq. 10).
CheckResult check_flexibility(const Superelement& s) {
  const RigidShare share = calc_rigid_share(s.inertia);
  const Eigen::MatrixXd acceleration = support::solve_positive_definite(share.mass, share.momenta);
  double largest = 0.0;
  for (const InterfaceError& one : s.certificate->interface) {
    const int node = s.points[static_cast<std::size_t>(one.point)].node;
    const Eigen::Vector2d r = s.node_positions.col(node);
    const Eigen::Matrix3d rigid{{1.0, 0.0, -r.y()}, {0.0, 1.0, r.x()}, {0.0, 0.0, 1.0}};
    const Eigen::VectorXd shape =
        (s.shapes.row(3 * node + one.freedom) - rigid.row(one.freedom) * acceleration).transpose();
    const double found = shape.dot(support::solve_positive_definite(s.stiffness, shape).col(0));
    const double expected = one.static_flexibility * (1.0 - one.static_error);
    if (one.static_flexibility > 0.0) {
      largest = std::max(largest, std::abs(found - expected) / one.static_flexibility);
    }
  }
  return {.name = "static flexibility against the certificate",
          .value = largest,
          .tolerance = 1e-8 + 100.0 * find_rounding(s)};
}

// By virtual work, the resultants of a unit load at a point do on each mode the work of the load itself
// (reduce, eq. 26). The scale is the largest work at any point: a point that moves with the reference node
// has none of its own but for rounding.
CheckResult check_point_loads(const Superelement& s) {
  const ElementWork work = calc_element_work(s, s.section_loads->point_load);
  const Eigen::VectorXd per_omega = calc_omega(s).cwiseInverse();
  double largest = 0.0;
  Eigen::Vector3d scale = Eigen::Vector3d::Zero();
  for (const NamedPoint& point : s.points) {
    const Eigen::MatrixXd of_point = s.shapes.middleRows(3 * point.node, 3) * per_omega.asDiagonal();
    scale = scale.cwiseMax(of_point.rowwise().lpNorm<Eigen::Infinity>());
  }
  scale.head<2>().setConstant(scale.head<2>().maxCoeff());
  for (std::size_t p = 0; p < s.points.size(); ++p) {
    const auto column = 3 * static_cast<Eigen::Index>(p);
    const Eigen::MatrixXd expected =
        per_omega.asDiagonal() * s.shapes.middleRows(3 * s.points[p].node, 3).transpose();
    const Eigen::MatrixXd found = per_omega.asDiagonal() * (work.axial + work.bending).middleCols(column, 3);
    for (int freedom = 0; freedom < 3; ++freedom) {
      const double error = (found - expected).col(freedom).lpNorm<Eigen::Infinity>();
      if (error > 0.0)
        largest = std::max(largest, scale(freedom) > 0.0 ? error / scale(freedom) : error * calc_omega(s)(0));
    }
  }
  return {.name = kPointLoadCheck,
          .value = largest,
          .tolerance = 1e-8 + 100.0 * find_rounding(s) + find_recorded(s, kHeldRoundingCheck)};
}

// No load between an element's ends: N and Q constant, M' = −Q.
CheckResult check_equilibrium(const Superelement& s) {
  double largest = 0.0;
  Eigen::RowVectorXd error = Eigen::RowVectorXd::Zero(s.frequency_hz.size()), scale = error;
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e) {
    const double length =
        (s.node_positions.col(s.elements(1, e)) - s.node_positions.col(s.elements(0, e))).norm();
    const auto first = s.resultants.middleRows<3>(6 * e), second = s.resultants.middleRows<3>(6 * e + 3);
    const Eigen::RowVectorXd moment = second.row(2) - first.row(2) + length * first.row(1);
    const Eigen::RowVectorXd force =
        length * ((second.row(0) - first.row(0)).cwiseAbs() + (second.row(1) - first.row(1)).cwiseAbs());
    error = error.cwiseMax(moment.cwiseAbs() + force);
    scale = scale.cwiseMax(first.row(2).cwiseAbs() + second.row(2).cwiseAbs() +
                           length * (first.row(0).cwiseAbs() + first.row(1).cwiseAbs()));
  }
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    if (error(i) > 0.0) largest = std::max(largest, scale(i) > 0.0 ? error(i) / scale(i) : kFailed);
  }
  return {.name = "equilibrium of the elements", .value = largest, .tolerance = 1e-6};
}

}  // namespace

std::vector<CheckResult> check_superelement(const Superelement& superelement) {
  std::vector<CheckResult> checks{check_orthogonality(superelement),      check_stiffness(superelement, true),
                                  check_stiffness(superelement, false),   check_damping(superelement),
                                  check_components(superelement.inertia), check_mass_matrix(superelement),
                                  check_held_node(superelement)};
  const bool has_beams = superelement.elements.cols() > 0;
  if (has_beams) checks.push_back(check_work(superelement));
  if (has_beams) checks.push_back(check_equilibrium(superelement));
  if (superelement.certificate) checks.push_back(check_flexibility(superelement));
  if (has_beams && superelement.section_loads) checks.push_back(check_point_loads(superelement));
  return checks;
}

}  // namespace sprung::reduce

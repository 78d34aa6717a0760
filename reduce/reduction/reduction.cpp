#include "reduce/reduction/reduction.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "fem/assembly.h"
#include "reduce/modes/canonical_basis.h"
#include "reduce/modes/clusters.h"
#include "reduce/modes/held_node.h"
#include "reduce/modes/rounding_error.h"
#include "reduce/reduction/distance_weighted_mass.h"
#include "reduce/reduction/inertia_invariants.h"
#include "reduce/reduction/reference_stiffness.h"
#include "reduce/reduction/superelement_checks.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

using support::InputError;
using support::NumericalError;

constexpr double kResidualTolerance = 1e-6;

void check_rounding(double error, double frequency_hz) {
  if (error <= kMaxRoundingError) return;
  throw NumericalError(fmt::format(
      "rounding spoils the lowest mode ({:.6g} Hz): its estimated relative error in ω² is {:.2g}, accepted "
      "is {:.0e}; refine the mesh less (the error grows with the fourth power of the number of elements)",
      frequency_hz, error, kMaxRoundingError));
}

// The canonical modes of the request.
struct Basis {
  Eigen::VectorXi cluster;    // n
  Eigen::MatrixXd shapes;     // 3N×n
  Eigen::MatrixXd stiffness;  // n×n, diagonal but for what a cluster's frequencies differ by
};

Basis make_basis(const ClampedModes& modes, const std::vector<int>& columns, const BasisFrame& frame,
                 int reference_node) {
  const Eigen::MatrixXd shapes = insert_node(modes.pairs.vectors, reference_node);
  const Eigen::MatrixXd rotation = calc_canonical_rotation(shapes, modes.cluster, frame);
  const Eigen::MatrixXd chosen = rotation(Eigen::all, columns);
  const Eigen::MatrixXd stiffness = chosen.transpose() * modes.pairs.omega_squared.asDiagonal() * chosen;
  return {.cluster = modes.cluster(columns),
          .shapes = shapes * chosen,
          .stiffness = 0.5 * (stiffness + stiffness.transpose())};
}

// The largest ‖φ − K⁻¹(M Φ S)‖ in the norm of strain energy, relative: it weighs what a mode holds of lower
// and of higher modes alike.
double calc_residual(const ModalProblem& problem, const Eigen::MatrixXd& vectors,
                     const Eigen::MatrixXd& stiffness) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(problem.stiffness);
  const Eigen::MatrixXd error = vectors - factor.solve(problem.mass * vectors * stiffness);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < error.cols(); ++i) {
    const double energy = std::abs(error.col(i).dot(problem.stiffness * error.col(i)));
    largest = std::max(largest, std::sqrt(energy / stiffness(i, i)));
  }
  return largest;
}

Eigen::MatrixXd calc_mode_resultants(const fem::BeamModel& model, const Eigen::MatrixXd& shapes) {
  const int num_elements = model.mesh.num_elements();
  Eigen::MatrixXd resultants(6 * num_elements, shapes.cols());
  for (int e = 0; e < num_elements; ++e) {
    const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    Eigen::MatrixXd ends(6, shapes.cols());
    ends.topRows(3) = shapes.middleRows(3 * nodes.first, 3);
    ends.bottomRows(3) = shapes.middleRows(3 * nodes.second, 3);
    resultants.middleRows(6 * e, 6) = fem::calc_resultants(fem::make_element(model, e)) * ends;
  }
  return resultants;
}

Eigen::VectorXd expand_damping(const Design& design, Eigen::Index num_modes) {
  if (design.damping_ratio.size() == 1)
    return Eigen::VectorXd::Constant(num_modes, design.damping_ratio.front());
  if (static_cast<Eigen::Index>(design.damping_ratio.size()) == num_modes) {
    return Eigen::Map<const Eigen::VectorXd>(design.damping_ratio.data(), num_modes);
  }
  throw InputError(design.damping_where,
                   fmt::format("{} damping ratios for {} modes; give one, or one for each",
                               design.damping_ratio.size(), num_modes));
}

// Members of a cluster have one frequency: the root of the mean square.
Eigen::VectorXd calc_frequencies(const Basis& basis) {
  Eigen::VectorXd frequency_hz(basis.cluster.size());
  for (ModeRange range; range.begin < frequency_hz.size(); range.begin = range.end) {
    range = find_cluster_of(basis.cluster, range.begin);
    const double mean = basis.stiffness.diagonal().segment(range.begin, range.size()).mean();
    frequency_hz.segment(range.begin, range.size()).setConstant(std::sqrt(mean) / (2.0 * std::numbers::pi));
  }
  return frequency_hz;
}

void copy_mesh(const fem::Mesh& mesh, const Eigen::Matrix2Xd& node_positions, Superelement& s) {
  s.node_ids = mesh.node_ids;
  s.node_positions = node_positions;
  for (const fem::Mesh::NamedNode& point : mesh.named_nodes) s.points.push_back({point.name, point.node});
  s.elements.resize(2, mesh.num_elements());
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const fem::Mesh::Element& element = mesh.elements[static_cast<std::size_t>(e)];
    s.elements.col(e) << element.first, element.second;
    s.element_sections.push_back(mesh.section_names[static_cast<std::size_t>(element.section)]);
  }
}

// The checks for which the finite element model is needed.
std::vector<CheckResult> check_modes(const ModalProblem& problem, const ClampedModes& modes,
                                     int reference_node, double rounding, const Superelement& s) {
  const Eigen::MatrixXd held = remove_node(s.shapes, reference_node);
  const auto num_found = static_cast<double>(modes.pairs.omega_squared.size());
  return {{.name = "modes missing below the highest one",
           .value = std::abs(static_cast<double>(modes.num_below) - num_found),
           .tolerance = 0.0},
          {.name = kRoundingCheck, .value = rounding, .tolerance = kMaxRoundingError},
          {.name = "residual of the modes",
           .value = calc_residual(problem, held, s.stiffness),
           .tolerance = kResidualTolerance}};
}

void require_checks(const std::vector<CheckResult>& checks) {
  for (const CheckResult& check : checks) {
    if (check.passed()) continue;
    throw NumericalError(
        fmt::format("the check '{}' of the reduced body failed: {:.3g}, tolerance {:.3g}; refine the "
                    "mesh less or ask for fewer modes",
                    check.name, check.value, check.tolerance));
  }
}

}  // namespace

ModalProblem make_modal_problem(const fem::BeamModel& model, int node) {
  const fem::AssembledMatrices matrices = fem::assemble(model);
  return {.stiffness = remove_node(matrices.stiffness, node), .mass = remove_node(matrices.mass, node)};
}

Superelement make_superelement(const Design& design, const ClampedModeOptions& options) {
  const fem::BeamModel& model = design.model;
  const Eigen::Vector2d origin = model.mesh.node_positions.col(design.reference_node);
  const Eigen::Matrix2Xd node_positions = model.mesh.node_positions.colwise() - origin;
  const ModalProblem problem = make_modal_problem(model, design.reference_node);
  const int num_needed = calc_num_modes_needed(design.modes, problem, options);
  const ClampedModes modes = calc_clamped_modes(problem, num_needed, options);
  const double rounding =
      estimate_rounding_error(problem.stiffness, modes.pairs.vectors.col(0), modes.pairs.omega_squared(0));
  check_rounding(rounding, std::sqrt(modes.pairs.omega_squared(0)) / (2.0 * std::numbers::pi));
  const std::vector<int> columns = select_modes(design.modes, modes, num_needed);

  const fem::MassMoments moments = fem::calc_mass_moments(model, origin);
  const BasisFrame frame =
      make_basis_frame(moments, node_positions, calc_distance_weighted_mass(model, origin));
  const Basis basis = make_basis(modes, columns, frame, design.reference_node);

  Superelement s;
  s.name = design.name;
  copy_mesh(model.mesh, node_positions, s);
  s.num_elastic_dofs = problem.size();
  s.frequency_hz = calc_frequencies(basis);
  s.damping_ratio = expand_damping(design, basis.shapes.cols());
  s.cluster = basis.cluster;
  s.shapes = basis.shapes;
  s.inertia = calc_inertia_invariants(moments, basis.shapes);
  s.stiffness = basis.stiffness;
  s.mass = s.inertia.M_ff;
  s.damping = (4.0 * std::numbers::pi * s.damping_ratio.cwiseProduct(s.frequency_hz)).asDiagonal();
  s.resultants = calc_mode_resultants(model, basis.shapes);
  s.geometric_stiffness =
      calc_reference_stiffness(model, design.reference_node, problem.stiffness, moments, basis.shapes);
  s.provenance = design.provenance;

  s.checks = check_modes(problem, modes, design.reference_node, rounding, s);
  for (const CheckResult& check : check_superelement(s)) s.checks.push_back(check);
  require_checks(s.checks);
  return s;
}

}  // namespace sprung::reduce

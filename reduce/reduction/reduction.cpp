#include "reduce/reduction/reduction.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "reduce/factors/row_major.h"
#include "reduce/reduction/body_basis.h"
#include "reduce/reduction/held_rounding.h"
#include "reduce/reduction/inertia_invariants.h"
#include "reduce/reduction/mesh_judgement.h"
#include "reduce/reduction/reference_stiffness.h"
#include "reduce/reduction/static_response.h"
#include "reduce/reduction/superelement_checks.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

using support::InputError;
using support::NumericalError;

RowMajorMatrix calc_mode_resultants(const fem::BeamModel& model, const Eigen::MatrixXd& shapes) {
  const int num_elements = model.mesh.num_elements();
  const RowMajorMatrix rows = shapes;  // what belongs to a node lies together
  RowMajorMatrix resultants(6 * num_elements, shapes.cols());
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> ends(6, shapes.cols());
  for (int e = 0; e < num_elements; ++e) {
    const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    ends << rows.middleRows<3>(3 * nodes.first), rows.middleRows<3>(3 * nodes.second);
    resultants.middleRows<6>(6 * e).noalias() = fem::calc_resultants(fem::make_element(model, e)) * ends;
  }
  return resultants;
}

// One ratio for each vector: of a free basis those of the free modes, then that of the residual vectors.
Eigen::VectorXd expand_damping(const Design& design, const std::vector<std::string>& kind) {
  const auto num_vectors = static_cast<Eigen::Index>(kind.size());
  const auto num_residual = static_cast<Eigen::Index>(std::count(kind.begin(), kind.end(), kResidualVector));
  const Eigen::Index num_modes = num_vectors - num_residual;
  const std::vector<double>& given = design.damping_ratio;
  if (given.size() != 1 && static_cast<Eigen::Index>(given.size()) != num_modes) {
    throw InputError(
        design.damping_where,
        fmt::format("{} damping ratios for {} modes; give one, or one for each", given.size(), num_modes));
  }
  if (given.size() != 1 && num_residual > 0 && !design.residual_damping_ratio) {
    throw InputError(
        design.damping_where,
        fmt::format("is a list for the {} free modes, and says nothing of the {} residual vectors; give "
                    "'residual_damping_ratio' beside it",
                    num_modes, num_residual));
  }
  Eigen::VectorXd ratios =
      Eigen::VectorXd::Constant(num_vectors, design.residual_damping_ratio.value_or(given[0]));
  for (Eigen::Index i = 0; i < num_modes; ++i)
    ratios(i) = given[given.size() == 1 ? 0 : static_cast<std::size_t>(i)];
  return ratios;
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

SectionSizes get_section_sizes(const fem::BeamModel& model) {
  const Eigen::Index num_elements = model.mesh.num_elements();
  SectionSizes sizes{.area = Eigen::VectorXd(num_elements), .modulus = Eigen::VectorXd(num_elements)};
  for (Eigen::Index e = 0; e < num_elements; ++e) {
    const int section = model.mesh.elements[static_cast<std::size_t>(e)].section;
    const fem::BeamProperties& properties = model.sections[static_cast<std::size_t>(section)];
    sizes.area[e] = properties.area;
    sizes.modulus[e] = properties.section_modulus;
  }
  return sizes;
}

// Matrices do not tell which of their entries axial forces change: geometric stiffness of no mode.
GeometricStiffness make_unknown_stiffness(std::size_t num_points) {
  GeometricStiffness none;
  none.point_loads.resize(num_points);
  return none;
}

// The integrals over the mass, and what they and loads at the points do to the held frame.
void add_inertia_and_loads(const Design& design, const BodyMatrices& matrices, const Eigen::MatrixXd& shapes,
                           Superelement& s) {
  const fem::BeamModel& model = design.model;
  const fem::MassMoments moments =
      make_mass_moments(design, model.mesh.node_positions.col(design.reference_node));
  s.inertia = calc_inertia_invariants(moments, shapes);
  s.geometric_stiffness = design.matrices ? make_unknown_stiffness(s.points.size())
                                          : calc_reference_stiffness(model, design.reference_node,
                                                                     *matrices.factor, moments, shapes);
  std::optional<StaticResponse> response = calc_static_response(
      model, design.reference_node, *matrices.factor, matrices.full.mass, moments, shapes);
  if (!response) return;
  // Symmetric by reciprocity, but for rounding.
  Eigen::MatrixXd& flexibility = response->deflections.point_load;
  flexibility = (0.5 * (flexibility + flexibility.transpose())).eval();
  s.section_loads = std::move(response->resultants);
  s.point_deflections = std::move(response->deflections);
  s.section_sizes = get_section_sizes(model);
}

// Whether a check is of what the reference node holds, and rounding spoils that.
bool is_spoilt_by_reference(const CheckResult& failed, const BodyMatrices& matrices) {
  if (failed.name == kMassConditionCheck)
    return true;  // nearly all of the body moves rigidly against the node
  const bool is_of_hold =
      failed.name == kResidualCheck || failed.name == kPointLoadCheck || failed.name == kHeldRoundingCheck;
  return is_of_hold && estimate_held_rounding(matrices).is_of_soft_reference();
}

// What to change where a check fails.
const char* name_remedy(const Design& design, const BodyMatrices& matrices) {
  if (design.matrices)
    return "the matrices are not exactly those of a body: masses that act along one axis more than along the "
           "other, and numbers that were cut short, are usual causes";
  if (matrices.free.num_massless > 0)
    return "a point without mass of its own, as at the end of a spring, may be the cause: give it a "
           "[[point_masses]], or lines more elements, or ask for a larger tolerance";
  return "stiffnesses or masses differ so much that rounding spoils it: refine the mesh less, or make what "
         "is "
         "soft stiffer, or rigid, or a body of its own";
}

void require_checks(const std::vector<CheckResult>& checks, const Design& design,
                    const BodyMatrices& matrices) {
  for (const CheckResult& check : checks) {
    if (check.passed()) continue;
    if (is_spoilt_by_reference(check, matrices)) {
      throw NumericalError(
          fmt::format("{}{} ({}: {:.3g}, tolerance {:.3g})", describe_soft_reference(design, matrices),
                      design.reduction.basis == BasisKind::kFree ? "" : "; or try the basis \"free\"",
                      check.name, check.value, check.tolerance));
    }
    throw NumericalError(
        fmt::format("the check '{}' of the reduced body failed: {:.3g}, tolerance {:.3g}; {}", check.name,
                    check.value, check.tolerance, name_remedy(design, matrices)));
  }
}

}  // namespace

Superelement make_superelement(const Design& design, const ClampedModeOptions& options) {
  const fem::BeamModel& model = design.model;
  options.report_progress("factors of the stiffness");
  const BodyMatrices matrices = make_body_matrices(design);
  BodyBasis basis = make_body_basis(design, matrices, options);

  options.report_progress("inertia, section loads and checks");
  Superelement s;
  s.name = design.name;
  copy_mesh(model.mesh, matrices.node_positions, s);
  s.num_elastic_dofs = matrices.count_held_modes();
  s.frequency_hz = calc_frequencies(basis);
  s.damping_ratio = expand_damping(design, basis.kind);
  s.cluster = basis.cluster;
  s.kind = basis.kind;
  add_inertia_and_loads(design, matrices, basis.shapes, s);
  s.stiffness = basis.stiffness;
  s.mass = s.inertia.M_ff;
  s.damping = (4.0 * std::numbers::pi * s.damping_ratio.cwiseProduct(s.frequency_hz)).asDiagonal();
  s.certificate = basis.certificate;
  s.resultants = calc_mode_resultants(model, basis.shapes);
  s.shapes = std::move(basis.shapes);
  s.shapes.conservativeResize(3 * model.mesh.num_nodes(), Eigen::NoChange);  // without internal freedoms
  s.provenance = design.provenance;

  s.checks = basis.checks;
  if (!design.matrices) s.checks.push_back(make_mesh_check(design, choose_judged_hz(design, s)));
  for (const CheckResult& check : check_superelement(s)) s.checks.push_back(check);
  require_checks(s.checks, design, matrices);
  return s;
}

}  // namespace sprung::reduce

#include "fem/assembly.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "fem/frame_sums.h"
#include "fem/geometric_stiffness.h"

namespace sprung::fem {

namespace {

// Adds the upper triangle, mirrored: exactly symmetric.
void add_symmetric(Eigen::SparseMatrix<double>& sum, const Mesh::Element& element, const Matrix6& matrix) {
  add_at_element(sum, element, matrix.selfadjointView<Eigen::Upper>());
}

void add_point_mass(Eigen::SparseMatrix<double>& sum, int node, double mass, double inertia) {
  add_at_node(sum, node, Eigen::Vector3d(mass, mass, inertia).asDiagonal());
}

// Eliminates the nodes that follow others. The product of three matrices is symmetric but for rounding.
void eliminate_symmetric(const BeamModel& model, Eigen::SparseMatrix<double>& matrix) {
  if (model.couplings.empty()) return;
  const Eigen::SparseMatrix<double> product = eliminate_followers(model.couplings, matrix);
  const Eigen::SparseMatrix<double> transposed = product.transpose();
  matrix = 0.5 * (product + transposed);
  matrix.makeCompressed();
}

// Springs at the freedoms that are eliminated, as stiff as the stiffest other one.
void hold_followers(const BeamModel& model, Eigen::SparseMatrix<double>& stiffness) {
  if (model.couplings.empty()) return;
  const double largest = stiffness.diagonal().maxCoeff();
  for (const Coupling& coupling : model.couplings) {
    for (int i = 0; i < 3; ++i) stiffness.coeffRef(3 * coupling.node + i, 3 * coupling.node + i) = largest;
  }
  stiffness.makeCompressed();
}

}  // namespace

AssembledMatrices assemble(const BeamModel& model) {
  check_beam_model(model, "assemble");
  AssembledMatrices matrices;
  matrices.stiffness = matrices.mass = make_frame_sum(model.mesh);
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const BeamElement element = make_element(model, e);
    add_symmetric(matrices.stiffness, nodes, calc_stiffness(element));
    add_symmetric(matrices.mass, nodes, calc_mass(element));
  }
  for (const PointMass& point : model.point_masses)
    add_point_mass(matrices.mass, point.node, point.mass, point.inertia);
  eliminate_symmetric(model, matrices.stiffness);
  eliminate_symmetric(model, matrices.mass);
  hold_followers(model, matrices.stiffness);
  return matrices;
}

AssembledMatrices assemble_rates(const BeamModel& model, const BeamModelRates& rates) {
  check_beam_model(model, "assemble_rates");
  AssembledMatrices matrices;
  matrices.stiffness = matrices.mass = make_frame_sum(model.mesh);
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const BeamElementRates element_rates{
        .first = rates.node_positions.col(nodes.first),
        .second = rates.node_positions.col(nodes.second),
        .properties = rates.sections[static_cast<std::size_t>(nodes.section)]};
    const BeamElement element = make_element(model, e);
    add_symmetric(matrices.stiffness, nodes, calc_stiffness_rate(element, element_rates));
    add_symmetric(matrices.mass, nodes, calc_mass_rate(element, element_rates));
  }
  for (std::size_t i = 0; i < model.point_masses.size(); ++i)
    add_point_mass(matrices.mass, model.point_masses[i].node, rates.point_masses[i].x(),
                   rates.point_masses[i].y());
  return matrices;
}

Eigen::SparseMatrix<double> assemble_geometric_stiffness(const BeamModel& model,
                                                         const std::vector<AxialForce>& axial_forces) {
  check_beam_model(model, "assemble_geometric_stiffness");
  if (axial_forces.size() != model.mesh.elements.size()) {
    throw std::invalid_argument(
        fmt::format("assemble_geometric_stiffness: {} axial forces, expected one for each of {} elements",
                    axial_forces.size(), model.mesh.elements.size()));
  }
  Eigen::SparseMatrix<double> stiffness = make_frame_sum(model.mesh);
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const auto index = static_cast<std::size_t>(e);
    add_symmetric(stiffness, model.mesh.elements[index],
                  calc_geometric_stiffness(make_element(model, e), axial_forces[index]));
  }
  return stiffness;
}

}  // namespace sprung::fem

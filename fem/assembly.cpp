#include "fem/assembly.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "fem/geometric_stiffness.h"

namespace sprung::fem {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

// Adds the upper triangle, mirrored: sums in the same order on both sides of the diagonal, hence exactly
// symmetric.
void add_symmetric(Triplets& triplets, const Mesh::Element& element, const Matrix6& matrix) {
  const auto dof = [&](int i) { return 3 * (i < 3 ? element.first : element.second) + i % 3; };
  for (int i = 0; i < 6; ++i) {
    triplets.emplace_back(dof(i), dof(i), matrix(i, i));
    for (int j = i + 1; j < 6; ++j) {
      triplets.emplace_back(dof(i), dof(j), matrix(i, j));
      triplets.emplace_back(dof(j), dof(i), matrix(i, j));
    }
  }
}

Eigen::SparseMatrix<double> make_matrix(int size, const Triplets& triplets) {
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  matrix.makeCompressed();
  return matrix;
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
  Triplets stiffness;
  Triplets mass;
  stiffness.reserve(36 * model.mesh.elements.size());
  mass.reserve(36 * model.mesh.elements.size() + 3 * model.point_masses.size());
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const BeamElement element = make_element(model, e);
    add_symmetric(stiffness, nodes, calc_stiffness(element));
    add_symmetric(mass, nodes, calc_mass(element));
  }
  for (const PointMass& point : model.point_masses) {
    mass.emplace_back(3 * point.node, 3 * point.node, point.mass);
    mass.emplace_back(3 * point.node + 1, 3 * point.node + 1, point.mass);
    mass.emplace_back(3 * point.node + 2, 3 * point.node + 2, point.inertia);
  }
  const int num_dofs = 3 * model.mesh.num_nodes();
  AssembledMatrices matrices{.stiffness = make_matrix(num_dofs, stiffness),
                             .mass = make_matrix(num_dofs, mass)};
  eliminate_symmetric(model, matrices.stiffness);
  eliminate_symmetric(model, matrices.mass);
  hold_followers(model, matrices.stiffness);
  return matrices;
}

AssembledMatrices assemble_rates(const BeamModel& model, const BeamModelRates& rates) {
  check_beam_model(model, "assemble_rates");
  Triplets stiffness, mass;
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const BeamElementRates element_rates{
        .first = rates.node_positions.col(nodes.first),
        .second = rates.node_positions.col(nodes.second),
        .properties = rates.sections[static_cast<std::size_t>(nodes.section)]};
    const BeamElement element = make_element(model, e);
    add_symmetric(stiffness, nodes, calc_stiffness_rate(element, element_rates));
    add_symmetric(mass, nodes, calc_mass_rate(element, element_rates));
  }
  for (std::size_t i = 0; i < model.point_masses.size(); ++i) {
    const int row = 3 * model.point_masses[i].node;
    mass.emplace_back(row, row, rates.point_masses[i].x());
    mass.emplace_back(row + 1, row + 1, rates.point_masses[i].x());
    mass.emplace_back(row + 2, row + 2, rates.point_masses[i].y());
  }
  const int num_dofs = 3 * model.mesh.num_nodes();
  return {.stiffness = make_matrix(num_dofs, stiffness), .mass = make_matrix(num_dofs, mass)};
}

Eigen::SparseMatrix<double> assemble_geometric_stiffness(const BeamModel& model,
                                                         const std::vector<AxialForce>& axial_forces) {
  check_beam_model(model, "assemble_geometric_stiffness");
  if (axial_forces.size() != model.mesh.elements.size()) {
    throw std::invalid_argument(
        fmt::format("assemble_geometric_stiffness: {} axial forces, expected one for each of {} elements",
                    axial_forces.size(), model.mesh.elements.size()));
  }
  Triplets stiffness;
  stiffness.reserve(36 * model.mesh.elements.size());
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const auto index = static_cast<std::size_t>(e);
    add_symmetric(stiffness, model.mesh.elements[index],
                  calc_geometric_stiffness(make_element(model, e), axial_forces[index]));
  }
  return make_matrix(3 * model.mesh.num_nodes(), stiffness);
}

}  // namespace sprung::fem

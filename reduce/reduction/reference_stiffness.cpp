#include "reduce/reduction/reference_stiffness.h"

#include <algorithm>

#include "fem/assembly.h"
#include "fem/axial_force.h"
#include "fem/geometric_stiffness.h"
#include "reduce/modes/held_node.h"

namespace sprung::reduce {

namespace {

constexpr Eigen::Index kLoadsAtOnce = 96;
constexpr Eigen::Index kValuesAtOnce = 1'000'000;  // of the elements' matrices: 8 MB

// K_G of the inertia of the frame in a moving frame, of which a part is spread over the elements.
Eigen::MatrixXd calc_inertia_stiffness(const fem::BeamModel& model, int reference_node,
                                       const StiffnessFactor& factor, const fem::MassMoments& moments,
                                       const Eigen::MatrixXd& shapes,
                                       const fem::FrameAcceleration& acceleration) {
  const Eigen::MatrixXd load = fem::calc_inertia_load(moments, acceleration);
  const Eigen::VectorXd displacement = fem::move_followers(
      model.couplings, insert_node(factor.solve(remove_node(load, reference_node)), reference_node));
  const std::vector<fem::AxialForce> forces = fem::calc_axial_forces(
      model, displacement, acceleration, model.mesh.node_positions.col(reference_node));
  const Eigen::MatrixXd product = fem::assemble_geometric_stiffness(model, forces) * shapes;
  const Eigen::MatrixXd K = shapes.transpose() * product;
  return 0.5 * (K + K.transpose());
}

// The lower triangle of a symmetric m×m matrix as a column, and back.
Eigen::Index count_entries(Eigen::Index m) {
  return m * (m + 1) / 2;
}
void pack(const Eigen::MatrixXd& matrix, Eigen::Ref<Eigen::VectorXd> column) {
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const Eigen::Index height = matrix.cols() - j;
    column.segment(at, height) = matrix.col(j).tail(height);
    at += height;
  }
}
Eigen::MatrixXd unpack(const Eigen::VectorXd& column, Eigen::Index m) {
  Eigen::MatrixXd matrix(m, m);
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < m; ++j) {
    matrix.col(j).tail(m - j) = column.segment(at, m - j);
    matrix.row(j).tail(m - j) = column.segment(at, m - j).transpose();
    at += m - j;
  }
  return matrix;
}

// Φᵀ K_G Φ of elements `begin` … `begin + count` under unit axial forces, packed: one column each.
Eigen::MatrixXd calc_element_stiffness(const fem::BeamModel& model, const Eigen::MatrixXd& shapes,
                                       Eigen::Index begin, Eigen::Index count) {
  Eigen::MatrixXd packed(count_entries(shapes.cols()), count);
  Eigen::MatrixXd ends(6, shapes.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto e = static_cast<int>(begin + i);
    const fem::Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    ends << shapes.middleRows<3>(3 * nodes.first), shapes.middleRows<3>(3 * nodes.second);
    const fem::Matrix6 K = fem::calc_geometric_stiffness(fem::make_element(model, e), {.constant = 1.0});
    pack(ends.transpose() * (K * ends), packed.col(i));
  }
  return packed;
}

// Axial forces of the elements under unit forces and a unit moment on each named point, three columns for
// each.
Eigen::MatrixXd calc_point_forces(const fem::BeamModel& model, int reference_node,
                                  const StiffnessFactor& factor) {
  const std::vector<fem::Mesh::NamedNode>& points = model.mesh.named_nodes;
  const auto num_loads = static_cast<Eigen::Index>(3 * points.size());
  Eigen::MatrixXd forces(model.mesh.num_elements(), num_loads);
  for (Eigen::Index begin = 0; begin < num_loads; begin += kLoadsAtOnce) {
    const Eigen::Index width = std::min(kLoadsAtOnce, num_loads - begin);
    Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * model.mesh.num_nodes(), width);
    for (Eigen::Index i = 0; i < width; ++i) {
      const auto point = static_cast<std::size_t>((begin + i) / 3);
      loads(3 * points[point].node + (begin + i) % 3, i) = 1.0;
    }
    loads = fem::move_loads_to_leaders(model.couplings, std::move(loads));
    const Eigen::MatrixXd displacements = fem::move_followers(
        model.couplings, insert_node(factor.solve(remove_node(loads, reference_node)), reference_node));
    forces.middleCols(begin, width) = fem::calc_axial_forces(model, displacements);
  }
  return forces;
}

// K_G is linear in the axial forces: the matrices of the elements are made once for all loads.
std::vector<std::array<Eigen::MatrixXd, 3>> calc_point_stiffness(const fem::BeamModel& model,
                                                                 const Eigen::MatrixXd& forces,
                                                                 const Eigen::MatrixXd& shapes) {
  const Eigen::Index m = shapes.cols(), num_elements = model.mesh.num_elements();
  Eigen::MatrixXd packed = Eigen::MatrixXd::Zero(count_entries(m), forces.cols());
  const Eigen::Index at_once =
      std::max<Eigen::Index>(1, kValuesAtOnce / std::max<Eigen::Index>(1, packed.rows()));
  for (Eigen::Index begin = 0; begin < num_elements && forces.cols() > 0; begin += at_once) {
    const Eigen::Index count = std::min(at_once, num_elements - begin);
    packed.noalias() += calc_element_stiffness(model, shapes, begin, count) * forces.middleRows(begin, count);
  }
  std::vector<std::array<Eigen::MatrixXd, 3>> stiffness;
  for (Eigen::Index load = 0; load < forces.cols(); load += 3) {
    stiffness.push_back(
        {unpack(packed.col(load), m), unpack(packed.col(load + 1), m), unpack(packed.col(load + 2), m)});
  }
  return stiffness;
}

}  // namespace

GeometricStiffness calc_reference_stiffness(const fem::BeamModel& model, int reference_node,
                                            const StiffnessFactor& factor, const fem::MassMoments& moments,
                                            const Eigen::MatrixXd& shapes) {
  const Eigen::Index m = std::min<Eigen::Index>(shapes.cols(), kMaxStiffenedModes);
  const Eigen::MatrixXd lowest = shapes.leftCols(m);
  const auto of_acceleration = [&](const fem::FrameAcceleration& acceleration) {
    return calc_inertia_stiffness(model, reference_node, factor, moments, lowest, acceleration);
  };
  GeometricStiffness geometric;
  geometric.centrifugal = of_acceleration({.omega_squared = 1.0});
  geometric.angular_acceleration = of_acceleration({.angular = 1.0});
  geometric.acceleration = {of_acceleration({.linear = {1.0, 0.0}}), of_acceleration({.linear = {0.0, 1.0}})};
  geometric.point_loads =
      calc_point_stiffness(model, calc_point_forces(model, reference_node, factor), lowest);
  return geometric;
}

}  // namespace sprung::reduce

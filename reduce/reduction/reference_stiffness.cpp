#include "reduce/reduction/reference_stiffness.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "fem/assembly.h"
#include "fem/axial_force.h"
#include "reduce/modes/held_node.h"

namespace sprung::reduce {

namespace {

// The held frame, factorised, and the modes to project on.
class ReferenceLoads {
 public:
  ReferenceLoads(const fem::BeamModel& model, int reference_node,
                 const Eigen::SparseMatrix<double>& held_stiffness, const Eigen::MatrixXd& shapes)
      : model_(model), node_(reference_node), factor_(held_stiffness), shapes_(shapes) {}

  // K_G of a load at the nodes, 3N, of which the frame's acceleration is the part spread over the elements.
  Eigen::MatrixXd calc_stiffness(const Eigen::VectorXd& load,
                                 const fem::FrameAcceleration& acceleration) const {
    const Eigen::VectorXd displacement = insert_node(factor_.solve(remove_node(load, node_)), node_);
    const std::vector<fem::AxialForce> forces =
        fem::calc_axial_forces(model_, displacement, acceleration, model_.mesh.node_positions.col(node_));
    const Eigen::MatrixXd K =
        shapes_.transpose() * (fem::assemble_geometric_stiffness(model_, forces) * shapes_);
    return 0.5 * (K + K.transpose());
  }

 private:
  const fem::BeamModel& model_;
  int node_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::MatrixXd shapes_;
};

}  // namespace

GeometricStiffness calc_reference_stiffness(const fem::BeamModel& model, int reference_node,
                                            const Eigen::SparseMatrix<double>& held_stiffness,
                                            const fem::MassMoments& moments, const Eigen::MatrixXd& shapes) {
  const Eigen::Index m = std::min<Eigen::Index>(shapes.cols(), kMaxStiffenedModes);
  const ReferenceLoads loads(model, reference_node, held_stiffness, shapes.leftCols(m));
  const auto of_acceleration = [&](const fem::FrameAcceleration& acceleration) {
    return loads.calc_stiffness(fem::calc_inertia_load(moments, acceleration), acceleration);
  };
  GeometricStiffness geometric;
  geometric.centrifugal = of_acceleration({.omega_squared = 1.0});
  geometric.angular_acceleration = of_acceleration({.angular = 1.0});
  geometric.acceleration = {of_acceleration({.linear = {1.0, 0.0}}), of_acceleration({.linear = {0.0, 1.0}})};
  for (const fem::Mesh::NamedNode& point : model.mesh.named_nodes) {
    const auto of_freedom = [&](int freedom) {
      return loads.calc_stiffness(Eigen::VectorXd::Unit(shapes.rows(), 3 * point.node + freedom), {});
    };
    geometric.point_loads.push_back({of_freedom(0), of_freedom(1), of_freedom(2)});
  }
  return geometric;
}

}  // namespace sprung::reduce

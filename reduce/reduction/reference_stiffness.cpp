#include "reduce/reduction/reference_stiffness.h"

#include <algorithm>

#include "fem/assembly.h"
#include "fem/axial_force.h"
#include "fem/geometric_stiffness.h"
#include "reduce/modes/held_node.h"
#include "reduce/reduction/point_stiffness.h"

namespace sprung::reduce {

namespace {

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
  geometric.point_loads = calc_point_stiffness(model, reference_node, factor, lowest);
  return geometric;
}

}  // namespace sprung::reduce

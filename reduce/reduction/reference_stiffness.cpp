#include "reduce/reduction/reference_stiffness.h"

#include <algorithm>

#include "fem/assembly.h"
#include "fem/axial_force.h"
#include "fem/geometric_stiffness.h"
#include "reduce/factors/tall_products.h"
#include "reduce/modes/held_node.h"
#include "reduce/reduction/point_stiffness.h"

namespace sprung::reduce {

namespace {

// Displacements of the held frame under its inertia in each of the accelerations, 3N×k.
Eigen::MatrixXd calc_displacements(const fem::BeamModel& model, int reference_node,
                                   const StiffnessFactor& factor, const fem::MassMoments& moments,
                                   const std::vector<fem::FrameAcceleration>& accelerations) {
  Eigen::MatrixXd loads(moments.N_x.size(), std::ssize(accelerations));
  for (Eigen::Index i = 0; i < loads.cols(); ++i)
    loads.col(i) = fem::calc_inertia_load(moments, accelerations[static_cast<std::size_t>(i)]);
  return fem::move_followers(model.couplings,
                             insert_node(factor.solve(remove_node(loads, reference_node)), reference_node));
}

// K_G of the inertia of the frame in each of the accelerations, of which a part is spread over the elements.
std::vector<Eigen::MatrixXd> calc_inertia_stiffness(
    const fem::BeamModel& model, int reference_node, const StiffnessFactor& factor,
    const fem::MassMoments& moments, const TallMatrix& shapes,
    const std::vector<fem::FrameAcceleration>& accelerations) {
  const Eigen::MatrixXd displacements =
      calc_displacements(model, reference_node, factor, moments, accelerations);
  const Eigen::Vector2d origin = model.mesh.node_positions.col(reference_node);
  std::vector<Eigen::MatrixXd> stiffness;
  for (std::size_t i = 0; i < accelerations.size(); ++i) {
    const std::vector<fem::AxialForce> forces = fem::calc_axial_forces(
        model, displacements.col(static_cast<Eigen::Index>(i)), accelerations[i], origin);
    const Eigen::MatrixXd K = project(fem::assemble_geometric_stiffness(model, forces), shapes);
    stiffness.emplace_back(0.5 * (K + K.transpose()));
  }
  return stiffness;
}

}  // namespace

GeometricStiffness calc_reference_stiffness(const fem::BeamModel& model, int reference_node,
                                            const StiffnessFactor& factor, const fem::MassMoments& moments,
                                            const Eigen::MatrixXd& shapes) {
  const Eigen::Index m = std::min<Eigen::Index>(shapes.cols(), kMaxStiffenedModes);
  const TallMatrix lowest = shapes.leftCols(m);
  const std::vector<Eigen::MatrixXd> of_inertia = calc_inertia_stiffness(
      model, reference_node, factor, moments, lowest,
      {{.omega_squared = 1.0}, {.angular = 1.0}, {.linear = {1.0, 0.0}}, {.linear = {0.0, 1.0}}});
  GeometricStiffness geometric;
  geometric.centrifugal = of_inertia[0];
  geometric.angular_acceleration = of_inertia[1];
  geometric.acceleration = {of_inertia[2], of_inertia[3]};
  geometric.point_loads = calc_point_stiffness(model, reference_node, factor, lowest);
  return geometric;
}

}  // namespace sprung::reduce

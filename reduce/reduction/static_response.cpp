#include "reduce/reduction/static_response.h"

#include <utility>

#include "fem/spread_loads.h"
#include "reduce/modes/held_node.h"

namespace sprung::reduce {

namespace {

// A matrix of an element: its inertia per acceleration of its ends, both in mesh axes.
using ElementMatrix = fem::Matrix6 (*)(const fem::BeamElement&);

class HeldFrame {
 public:
  HeldFrame(const fem::BeamModel& model, int node, const StiffnessFactor& factor)
      : model_(model), node_(node), factor_(factor) {}

  // Responses to loads at the nodes, 3N×k. The part of them that is spread over the elements is the inertia
  // under `accelerations` of the nodes, 3N×k; nullptr: there is none.
  struct Response {
    Eigen::MatrixXd resultants, deflections;
  };
  Response calc_response(const Eigen::MatrixXd& loads, const Eigen::MatrixXd& accelerations,
                         ElementMatrix element_matrix) const {
    const Eigen::MatrixXd on_leaders = fem::move_loads_to_leaders(model_.couplings, loads);
    const Eigen::MatrixXd displacements = fem::move_followers(
        model_.couplings, insert_node(factor_.solve(remove_node(on_leaders, node_)), node_));
    Response response{.resultants = Eigen::MatrixXd(6 * model_.mesh.num_elements(), loads.cols()),
                      .deflections = Eigen::MatrixXd(3 * model_.mesh.named_nodes.size(), loads.cols())};
    for (int e = 0; e < model_.mesh.num_elements(); ++e) {
      const fem::BeamElement element = fem::make_element(model_, e);
      Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(6, loads.cols());
      if (element_matrix != nullptr) spread = -element_matrix(element) * gather(accelerations, e);
      response.resultants.middleRows(6 * e, 6) =
          fem::calc_loaded_resultants(element, gather(displacements, e), spread);
    }
    Eigen::Index row = 0;
    for (const fem::Mesh::NamedNode& point : model_.mesh.named_nodes) {
      response.deflections.middleRows(row, 3) = displacements.middleRows(3 * point.node, 3);
      row += 3;
    }
    return response;
  }

 private:
  Eigen::MatrixXd gather(const Eigen::MatrixXd& nodal, int element) const {
    const fem::Mesh::Element& nodes = model_.mesh.elements[static_cast<std::size_t>(element)];
    Eigen::MatrixXd ends(6, nodal.cols());
    ends << nodal.middleRows(3 * nodes.first, 3), nodal.middleRows(3 * nodes.second, 3);
    return ends;
  }

  const fem::BeamModel& model_;
  int node_;
  const StiffnessFactor& factor_;
};

// Accelerations of the nodes at unit accelerations of the frame: along x, along y, angular, and that towards
// the origin at ω = 1. The shape functions contain all of them.
Eigen::MatrixXd make_frame_accelerations(const fem::BeamModel& model, int reference_node,
                                         Eigen::Index num_rows) {
  const Eigen::Vector2d origin = model.mesh.node_positions.col(reference_node);
  Eigen::MatrixXd accelerations = Eigen::MatrixXd::Zero(num_rows, 4);
  for (int node = 0; node < model.mesh.num_nodes(); ++node) {
    const Eigen::Vector2d r = model.mesh.node_positions.col(node) - origin;
    accelerations.middleRows(3 * node, 3) << 1.0, 0.0, -r.y(), -r.x(),  //
        0.0, 1.0, r.x(), -r.y(),                                        //
        0.0, 0.0, 1.0, 0.0;
  }
  return accelerations;
}

Eigen::MatrixXd make_point_loads(const fem::Mesh& mesh, Eigen::Index num_rows) {
  const auto num_points = static_cast<Eigen::Index>(mesh.named_nodes.size());
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(num_rows, 3 * num_points);
  for (Eigen::Index p = 0; p < num_points; ++p) {
    const int node = mesh.named_nodes[static_cast<std::size_t>(p)].node;
    loads.block(3 * node, 3 * p, 3, 3).setIdentity();
  }
  return loads;
}

}  // namespace

std::optional<StaticResponse> calc_static_response(const fem::BeamModel& model, int reference_node,
                                                   const StiffnessFactor& factor,
                                                   const Eigen::SparseMatrix<double>& mass,
                                                   const fem::MassMoments& moments,
                                                   const Eigen::MatrixXd& shapes) {
  const Eigen::Index n = shapes.cols(), num_points = static_cast<Eigen::Index>(model.mesh.named_nodes.size());
  const Eigen::Index num_loads = 3 * num_points + 4 + 2 * n;
  const bool has_beams = model.mesh.num_elements() > 0;
  if (has_beams && (6 * model.mesh.num_elements() + 3 * num_points) * num_loads > kMostResponseValues)
    return {};
  const HeldFrame frame(model, reference_node, factor);
  const Eigen::MatrixXd of_frame = make_frame_accelerations(model, reference_node, mass.rows());
  const Eigen::SparseMatrix<double> NxNy_transposed = moments.NxNy.transpose();
  Eigen::MatrixXd of_inertia = -(mass * of_frame);
  // No displacement of the leaders gives this field at the nodes that follow them.
  if (!model.couplings.empty()) of_inertia.col(3) = moments.x_N_x + moments.y_N_y;
  StaticResponse response;
  const auto take = [&](HeldFrame::Response&& one, Eigen::MatrixXd UnitLoads::*loads) {
    response.resultants.*loads = std::move(one.resultants);
    response.deflections.*loads = std::move(one.deflections);
  };
  take(frame.calc_response(make_point_loads(model.mesh, mass.rows()), {}, nullptr), &UnitLoads::point_load);
  take(frame.calc_response(of_inertia, of_frame, fem::calc_mass), &UnitLoads::acceleration);
  take(frame.calc_response(-(mass * shapes), shapes, fem::calc_mass), &UnitLoads::modal_acceleration);
  take(frame.calc_response((moments.NxNy - NxNy_transposed) * shapes, shapes, fem::calc_turned_mass),
       &UnitLoads::turned_acceleration);
  return response;
}

}  // namespace sprung::reduce

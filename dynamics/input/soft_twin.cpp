#include "dynamics/input/soft_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "dynamics/bodies/body_equations.h"
#include "dynamics/input/uncovered_loads.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

namespace {

[[noreturn]] void refuse_bracket(const BodyDescription& body, const std::string& reason) {
  throw support::InputError(
      body.location, fmt::format("body '{}' has no bracket of its frequencies: {}", body.name, reason));
}

const reduce::Certificate& require_bound(const BodyDescription& description, const Body& body,
                                         const reduce::Superelement& superelement) {
  const auto has_bound = [](const reduce::Certificate& one) {
    return one.is_bounded() && (one.cutoff_hz == 0.0 || one.cutoff_hz > one.highest_hz);
  };
  if (!superelement.certificate || !has_bound(*superelement.certificate))
    refuse_bracket(description, "the certificate of its superelement has no bound; take the basis \"free\"");
  if (body.num_modes() != superelement.num_modes()) {
    refuse_bracket(description, fmt::format("it has {} of {} modes; set modes.{} = \"certified\"",
                                            body.num_modes(), superelement.num_modes(), body.name));
  }
  if (body.stiffening) refuse_bracket(description, "its stiffness depends on axial forces (stiffening)");
  const reduce::Certificate& certificate = *superelement.certificate;
  if (certificate.cutoff_hz > 0.0 && certificate.largest_error() > 0.0 && certificate.soft_loads.rows() == 0)
    refuse_bracket(description, "its certificate has no soft loads, because its interface is too large");
  return certificate;
}

// Whether the soft modes are made for all freedoms of the reference node.
bool has_reference(const reduce::Certificate& certificate) {
  return certificate.soft_reference.cols() == 3;
}

// Shapes of the soft modes at a node: x, y and rotation, 3×q.
Eigen::MatrixXd calc_soft_shapes(const reduce::Superelement& superelement, Eigen::Index node) {
  const reduce::Certificate& certificate = *superelement.certificate;
  if (has_reference(certificate) && node == reduce::find_reference_node(superelement))
    return certificate.soft_reference.transpose();
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3, certificate.soft_loads.rows());
  for (std::size_t j = 0; j < certificate.interface.size(); ++j) {
    const reduce::InterfaceError& one = certificate.interface[j];
    if (superelement.points[static_cast<std::size_t>(one.point)].node == node)
      shapes.row(one.freedom) = certificate.soft_loads.col(static_cast<Eigen::Index>(j)).transpose();
  }
  return shapes;
}

// Whether the errors at all three freedoms of a node are bounded.
bool has_in_interface(const reduce::Superelement& superelement, Eigen::Index node) {
  std::array<bool, 3> found{};
  for (const reduce::InterfaceError& one : superelement.certificate->interface)
    if (superelement.points[static_cast<std::size_t>(one.point)].node == node)
      found[static_cast<std::size_t>(one.freedom)] = true;
  return std::all_of(found.begin(), found.end(), [](bool is_found) { return is_found; });
}

// S r φ of a row of rotations φ: the displacement of a point at r that turns with them, 2×q.
Eigen::MatrixXd turned_rows(const Eigen::Vector2d& r, const Eigen::RowVectorXd& rotations) {
  return turned(r) * rotations;
}

Eigen::MatrixXd join_columns(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd joined(left.rows(), left.cols() + right.cols());
  joined << left, right;
  return joined;
}

Eigen::MatrixXd join_diagonally(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  const Eigen::Index n = first.rows(), q = second.rows();
  Eigen::MatrixXd joined = Eigen::MatrixXd::Zero(n + q, n + q);
  joined.topLeftCorner(n, n) = first;
  joined.bottomRightCorner(q, q) = second;
  return joined;
}

// Adds the soft modes of the free body to a body, in its frame: with Θ their motion of the reference node
// they are V − RΘ, and have the momenta −M_r Θ (reduce/basis, eqs. 1, 3).
void add_soft_modes(Body& body, const reduce::Superelement& superelement,
                    const Eigen::MatrixXd& of_reference) {
  const reduce::Certificate& certificate = *superelement.certificate;
  const Eigen::Index q = certificate.soft_loads.rows();
  Eigen::Matrix3d rigid = Eigen::Matrix3d::Zero();
  rigid.diagonal() << body.mass, body.mass, body.second_moment;
  rigid(0, 2) = rigid(2, 0) = -body.first_moment.y();
  rigid(1, 2) = rigid(2, 1) = body.first_moment.x();
  const Eigen::MatrixXd momenta = -rigid * of_reference;  // 3×q
  Eigen::MatrixXd old_momenta(3, body.num_modes());
  old_momenta << body.P, body.c;
  const Eigen::MatrixXd coupling = -old_momenta.transpose() * of_reference;  // n×q
  const Eigen::Index n = body.num_modes();
  const Eigen::MatrixXd own = Eigen::MatrixXd::Identity(q, q) - of_reference.transpose() * momenta;
  body.M_ff = join_diagonally(body.M_ff, own);
  body.M_ff.topRightCorner(n, q) = coupling;
  body.M_ff.bottomLeftCorner(q, n) = coupling.transpose();
  body.P = join_columns(body.P, momenta.topRows(2));
  body.c = join_columns(body.c, momenta.row(2)).row(0);
  body.d = join_columns(body.d, Eigen::RowVectorXd::Zero(q)).row(0);
  body.M_tt = join_diagonally(body.M_tt, Eigen::MatrixXd::Identity(q, q));
  body.B = join_diagonally(body.B, Eigen::MatrixXd::Zero(q, q));
  const double cutoff = 2.0 * std::numbers::pi * certificate.cutoff_hz;
  body.stiffness = join_diagonally(body.stiffness, cutoff * cutoff * Eigen::MatrixXd::Identity(q, q));
  body.damping = join_diagonally(body.damping, Eigen::MatrixXd::Zero(q, q));
  body.modal_mass.conservativeResize(n + q);
  body.modal_mass.tail(q).setOnes();
  body.mode_scale.conservativeResize(n + q);
  const Eigen::MatrixXd moved = join_columns(certificate.soft_loads, of_reference.transpose());
  body.mode_scale.tail(q) = moved.cwiseAbs().rowwise().maxCoeff();
  for (int k = 1; k <= q; ++k) body.mode_numbers.push_back(superelement.num_modes() + k);
}

}  // namespace

SoftTwin make_soft_twin(const Vehicle& vehicle, const Model& model) {
  SoftTwin twin{.model = model, .highest_hz = std::numeric_limits<double>::infinity(), .unproved = {}};
  const std::vector<VehiclePoint> points = list_points(vehicle);
  const std::vector<UncoveredLoad> uncovered = find_uncovered_loads(vehicle, model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].num_modes() == 0) continue;
    const BodyDescription& description = vehicle.bodies[b];
    const reduce::Superelement& superelement = *vehicle.superelement_of(description);
    const reduce::Certificate& certificate = require_bound(description, model.bodies[b], superelement);
    const Eigen::Index reference = reduce::find_reference_node(superelement);
    const bool is_proved_at_reference = has_reference(certificate) || certificate.cutoff_hz == 0.0;
    for (const UncoveredLoad& load : uncovered) {
      if (load.body != static_cast<int>(b) || (is_proved_at_reference && load.node == reference)) continue;
      refuse_bracket(description, load.describe());
    }
    twin.highest_hz = std::min(twin.highest_hz, certificate.highest_hz);
    if (!is_proved_at_reference && !has_in_interface(superelement, reference))
      twin.unproved.push_back(description.name);
    const Eigen::MatrixXd of_reference = calc_soft_shapes(superelement, reference);
    add_soft_modes(twin.model.bodies[b], superelement, of_reference);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const VehiclePoint& point = points[i];
      if (point.body != static_cast<int>(b)) continue;
      Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3, of_reference.cols());
      if (point.kind == VehiclePoint::Kind::kNode) {
        shapes = calc_soft_shapes(superelement, point.node) - of_reference;
        shapes.topRows(2) += turned_rows(point.offset, shapes.row(2));
        shapes.topRows(2) -= turned_rows(superelement.node_positions.col(point.node), of_reference.row(2));
      } else if (point.kind == VehiclePoint::Kind::kCenterOfMass) {
        shapes.topRows(2) = twin.model.bodies[b].P.rightCols(shapes.cols()) / twin.model.bodies[b].mass;
      }
      Marker& marker = twin.model.markers[i];
      marker.Phi = join_columns(marker.Phi, shapes);
    }
  }
  number_model(twin.model);
  return twin;
}

Eigen::VectorXd insert_soft_modes(const Model& model, const SoftTwin& twin, const Eigen::VectorXd& q) {
  Eigen::VectorXd inserted = Eigen::VectorXd::Zero(twin.model.num_coordinates);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    inserted.segment(twin.model.bodies[b].first_coordinate, body.num_coordinates()) =
        q.segment(body.first_coordinate, body.num_coordinates());
  }
  return inserted;
}

}  // namespace sprung::dynamics

#include "dynamics/bracket/soft_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "dynamics/bodies/body_equations.h"
#include "dynamics/input/uncovered_loads.h"
#include "tools/support/dense/join_columns.h"
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
    refuse_bracket(description,
                   "the certificate of its superelement has no bound up to the end of its band; take "
                   "the basis \"free\", or a lower highest_frequency, in the design");
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

// S r φ of a row of rotations φ: the displacement of a point at r that turns with them, 2×q.
Eigen::MatrixXd turned_rows(const Eigen::Vector2d& r, const Eigen::RowVectorXd& rotations) {
  return turned(r) * rotations;
}

// Shapes of the soft modes at a point of a body that has them, in the body's frame, 3×q.
Eigen::MatrixXd calc_point_shapes(const VehiclePoint& point, const reduce::Superelement& superelement,
                                  const Eigen::MatrixXd& of_reference, const Body& body) {
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3, of_reference.cols());
  if (point.kind == VehiclePoint::Kind::kNode) {
    shapes = calc_soft_shapes(superelement, point.node) - of_reference;
    shapes.topRows(2) += turned_rows(point.offset, shapes.row(2));
    shapes.topRows(2) -= turned_rows(superelement.node_positions.col(point.node), of_reference.row(2));
  } else if (point.kind == VehiclePoint::Kind::kCenterOfMass) {
    shapes.topRows(2) = body.P.rightCols(shapes.cols()) / body.mass;
  }
  return shapes;
}

void require_covered_loads(const Vehicle& vehicle, const Model& model) {
  for (const UncoveredLoad& load : find_uncovered_loads(vehicle, model)) {
    const BodyDescription& description = vehicle.bodies[static_cast<std::size_t>(load.body)];
    const reduce::Superelement& superelement = *vehicle.superelement_of(description);
    const reduce::Certificate& certificate = *superelement.certificate;
    const bool is_reference = load.node == reduce::find_reference_node(superelement);
    if (is_reference && (certificate.soft_reference.cols() == 3 || certificate.cutoff_hz == 0.0)) continue;
    refuse_bracket(description, load.describe());
  }
}

// The place of a body's first soft mode among the coordinates.
Eigen::Index find_first_soft(const SoftTwin& twin, const SoftTwin::SoftBody& soft) {
  return twin.model.bodies[soft.body].first_coordinate + 3 + soft.num_modes;
}

}  // namespace

SoftTwin make_soft_twin(const Vehicle& vehicle, const Model& model) {
  SoftTwin twin{.model = model,
                .bodies = {},
                .is_soft = {},
                .highest_hz = std::numeric_limits<double>::infinity(),
                .unproved = {}};
  const std::vector<VehiclePoint> points = list_points(vehicle);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].num_modes() == 0) continue;
    const BodyDescription& description = vehicle.bodies[b];
    const reduce::Superelement& superelement = *vehicle.superelement_of(description);
    const reduce::Certificate& certificate = require_bound(description, model.bodies[b], superelement);
    twin.highest_hz = std::min(twin.highest_hz, certificate.highest_hz);
    if (certificate.soft_static_share.size() != certificate.soft_loads.rows())
      twin.unproved.push_back(description.name);
    Body& body = twin.model.bodies[b];
    add_soft_modes(body, superelement);
    twin.bodies.push_back(
        {.body = b, .num_modes = model.bodies[b].num_modes(), .stiffness = calc_soft_stiffness(certificate)});
    const Eigen::MatrixXd of_reference =
        calc_soft_shapes(superelement, reduce::find_reference_node(superelement));
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].body != static_cast<int>(b)) continue;
      Marker& marker = twin.model.markers[i];
      marker.Phi =
          support::join_columns(marker.Phi, calc_point_shapes(points[i], superelement, of_reference, body));
    }
  }
  require_covered_loads(vehicle, model);
  number_model(twin.model);
  twin.is_soft.assign(static_cast<std::size_t>(twin.model.num_coordinates), false);
  for (const SoftTwin::SoftBody& soft : twin.bodies)
    std::fill_n(twin.is_soft.begin() + find_first_soft(twin, soft), soft.stiffness.at_rest.size(), true);
  return twin;
}

Eigen::VectorXd insert_soft_modes(const SoftTwin& twin, const Eigen::VectorXd& q) {
  Eigen::VectorXd inserted = Eigen::VectorXd::Zero(twin.model.num_coordinates);
  for (Eigen::Index from = 0, to = 0; to < inserted.size(); ++to)
    if (!twin.is_soft[static_cast<std::size_t>(to)]) inserted[to] = q[from++];
  return inserted;
}

Eigen::VectorXd make_softening(const SoftTwin& twin) {
  Eigen::VectorXd softening = Eigen::VectorXd::Zero(twin.model.num_coordinates);
  for (const SoftTwin::SoftBody& soft : twin.bodies)
    softening.segment(find_first_soft(twin, soft), soft.stiffness.at_rest.size()) =
        soft.stiffness.in_motion - soft.stiffness.at_rest;
  return softening;
}

UnknownMass make_unknown_mass(const SoftTwin& twin, const Eigen::VectorXd& q) {
  std::vector<UnknownInertia> unknown;
  for (const SoftTwin::SoftBody& soft : twin.bodies) {
    const Body& body = twin.model.bodies[soft.body];
    unknown.push_back(calc_unknown_inertia(body, soft.num_modes, soft.stiffness,
                                           q.segment(body.first_coordinate + 3, body.num_modes())));
  }
  const Eigen::MatrixXd nothing = Eigen::MatrixXd::Zero(q.size(), q.size());
  // Of each body, with the weights β = b √J_c/‖u_m‖ and, if there is a, α = a √J_c/‖u‖.
  const auto make_mass = [&](double b, std::optional<double> a) {
    Eigen::MatrixXd mass = nothing;
    for (std::size_t i = 0; i < unknown.size(); ++i) {
      const SoftTwin::SoftBody& soft = twin.bodies[i];
      const auto& [known, missed, radius, elastic_mass] = unknown[i];
      const Eigen::Index num_soft = soft.stiffness.at_rest.size();
      if (num_soft == 0) continue;
      const Eigen::Index first = twin.model.bodies[soft.body].first_coordinate;
      mass(first + 2, first + 2) += b * missed * radius + missed * (missed + 2.0 * known);
      mass.block(first + 3, first + 3, soft.num_modes, soft.num_modes) +=
          missed / (b * radius) * elastic_mass;
      if (!a) continue;
      const double all = known + missed;
      mass(first + 2, first + 2) += *a * all * radius;
      mass.diagonal().segment(first + 3 + soft.num_modes, num_soft).array() += all / (*a * radius);
    }
    return mass;
  };
  std::vector<int> kept;
  for (int i = 0; i < twin.model.num_coordinates; ++i)
    if (!twin.is_soft[static_cast<std::size_t>(i)]) kept.push_back(i);
  UnknownMass result;
  for (const double b : {1e-2, 1e-1, 1.0, 10.0}) {
    result.below.emplace_back(make_mass(b, {})(kept, kept));
    for (const double a : {1e-3, 1e-2, 1e-1, 1.0}) result.above.push_back(make_mass(b, a));
  }
  return result;
}

}  // namespace sprung::dynamics

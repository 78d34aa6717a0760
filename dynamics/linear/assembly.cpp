#include "dynamics/linear/assembly.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "dynamics/linear/rigid_placement.h"
#include "dynamics/system/constrained_equations.h"
#include "dynamics/system/partition.h"
#include "tools/support/dense/orthogonal_factors.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxClosingIterations = 60;
constexpr double kClosingTolerance = 1e-12;  // of the length scale
constexpr double kLoaded = 1e-6;             // smaller ones of forces of the order 1 are rounding errors
constexpr double kRegularisation = 1e-12;    // of the largest diagonal entry
// Of what the mass of modes makes them move: a gap that bodies close as rigid ones shall not strain them.
constexpr double kReluctanceToDeform = 1e-6;

std::size_t joint_of_constraint(const Model& model, int constraint) {
  std::size_t joint = model.joints.size() - 1;
  while (model.joint_rows[joint] > constraint) --joint;
  return joint;
}

std::string name_constraints(const Model& model, const std::vector<int>& constraints) {
  std::vector<std::string> names;
  for (const int i : constraints) {
    const std::size_t joint = joint_of_constraint(model, i);
    names.push_back(fmt::format("'{}' ({})", model.joints[joint]->name,
                                model.joints[joint]->constraint_name(i - model.joint_rows[joint])));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void throw_cannot_close(const Model& model, const Eigen::VectorXd& phi) {
  Eigen::Index worst = 0;
  phi.cwiseAbs().maxCoeff(&worst);
  std::vector<int> open;
  for (Eigen::Index i = 0; i < phi.size(); ++i) {
    if (std::abs(phi[i]) > 0.1 * std::abs(phi[worst])) open.push_back(static_cast<int>(i));
  }
  const std::size_t joint = joint_of_constraint(model, static_cast<int>(worst));
  throw support::InputError(
      model.joints[joint]->location,
      fmt::format("the joints cannot be closed from the given positions: '{}' stays {:.3g} {} apart; "
                  "joints that stay open: {}; check positions, angles and points of the bodies they join",
                  model.joints[joint]->name, std::abs(phi[worst]),
                  model.joints[joint]->constraint_unit(static_cast<int>(worst) - model.joint_rows[joint]),
                  name_constraints(model, open)));
}

// Flexible bodies that dependent constraints load by forces in equilibrium at several points, without work on
// the active modes, of which there may be none. With more modes the forces would do work, and the constraints
// would be independent.
// @param terms  after update_jacobian   @param dependent  from find_dependent_constraints
std::vector<int> find_bodies_short_of_modes(const SystemTerms& terms, const std::vector<int>& dependent) {
  const Model& model = terms.model();
  const BlockJacobian& jacobian = terms.jacobian();
  const Eigen::MatrixXd rows = Eigen::MatrixXd(jacobian.sparse())(dependent, Eigen::all);
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(model.num_constraints);
  lambda(dependent) = support::calc_left_singular_pairs(rows)
                          .vectors.rightCols<1>();  // forces of the joints that move nothing
  // For each body and position in it, the force there and its torque about the body frame's origin.
  std::map<std::tuple<int, double, double>, Eigen::Vector3d> loads;
  for (const BlockJacobian::Block& block : jacobian.blocks()) {
    const Joint& joint = *model.joints[joint_of_constraint(model, block.row)];
    const Marker& a = model.markers[static_cast<std::size_t>(joint.marker_a)];
    const Marker& marker = a.body == block.body ? a : model.markers[static_cast<std::size_t>(joint.marker_b)];
    const auto key = std::make_tuple(static_cast<int>(block.body), marker.p_BP.x(), marker.p_BP.y());
    Eigen::Vector3d& load = loads.try_emplace(key, Eigen::Vector3d::Zero()).first->second;
    for (int i = 0; i < block.num_rows; ++i) {
      const double* row = jacobian.data() + block.offset + i * block.num_columns;
      load += lambda[block.row + i] * Eigen::Map<const Eigen::Vector3d>(row);
    }
  }
  std::vector<int> found;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const auto is_loaded = [&](const auto& entry) {
      return std::get<0>(entry.first) == static_cast<int>(b) && entry.second.norm() > kLoaded;
    };
    if (model.bodies[b].num_available_modes > 0 && std::count_if(loads.begin(), loads.end(), is_loaded) > 1)
      found.push_back(static_cast<int>(b));
  }
  return found;
}

[[noreturn]] void throw_redundant(const SystemTerms& terms, const std::vector<int>& dependent) {
  const Model& model = terms.model();
  const support::SourceLocation& location =
      model.joints[joint_of_constraint(model, dependent.back())]->location;
  const std::string names = name_constraints(model, dependent);
  const std::vector<int> bodies = find_bodies_short_of_modes(terms, dependent);
  if (!bodies.empty()) {
    std::vector<std::string> counts;
    bool has_more = false;
    for (const int b : bodies) {
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      counts.push_back(
          fmt::format("'{}' has ({} of {})", body.name, body.num_modes(), body.num_available_modes));
      has_more |= body.num_modes() < body.num_available_modes;
    }
    throw support::InputError(
        location,
        fmt::format("too few modes: with those that {}, it cannot deform as {} require, so that "
                    "their reactions have no unique value; {}",
                    fmt::join(counts, " or "), names,
                    has_more
                        ? "take more modes of it"
                        : "reduce it with more vectors: with these points in its [interface], or up to a "
                          "higher frequency"));
  }
  throw support::InputError(
      location,
      fmt::format(
          "redundant joints: {} hold the same motion more than once, so that their reactions have no "
          "unique value; leave one of them out or free a direction. If they do so in this position alone (a "
          "change point of the mechanism), start slightly away from it",
          names));
}

// The joint that is farthest open as drawn.
void find_widest_gap(const Model& model, const Eigen::VectorXd& phi, AssemblyReport& report) {
  for (int i = 0; i < model.num_constraints; ++i) {
    const std::size_t joint = joint_of_constraint(model, i);
    const bool is_angle = model.joints[joint]->is_angle(i - model.joint_rows[joint]);
    if (is_angle || std::abs(phi[i]) <= report.widest_gap) continue;
    report.widest_gap = std::abs(phi[i]);
    report.open_joint = model.joints[joint]->name;
  }
}

// The prescribed motion whose coordinate is farthest from its value as drawn.
void find_widest_motion_gap(const Model& model, const Eigen::VectorXd& phi, AssemblyReport& report) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = *model.joints[j];
    if (!joint.is_motion()) continue;
    const double gap = phi[model.joint_rows[j]];
    const double natural = std::abs(gap) / (joint.is_angle(0) ? 1.0 : model.length_scale);
    if (natural > report.motion_gap.natural_size)
      report.motion_gap = {joint.name, std::string(joint.constraint_unit(0)), gap, natural};
  }
}

// Inverse masses of the coordinates, with which bodies deform only where they cannot move as rigid ones.
// @param terms  after update_mass
Eigen::VectorXd make_reluctant_masses(const SystemTerms& terms) {
  Eigen::VectorXd inverse_mass = terms.calc_metric().cwiseInverse();
  for (const Body& body : terms.model().bodies)
    inverse_mass.segment(body.first_coordinate + 3, body.num_modes()) *= kReluctanceToDeform;
  return inverse_mass;
}

// The least change of coordinates, or of their rates, that takes a residual away to first order; none where
// the joints are singular.
// @param terms  after update_jacobian
std::optional<Eigen::VectorXd> find_least_change(const SystemTerms& terms,
                                                 const Eigen::VectorXd& inverse_mass,
                                                 const Eigen::VectorXd& residual) {
  const Eigen::SparseMatrix<double> Phi_q = terms.jacobian().sparse();
  const Eigen::SparseMatrix<double> weighted = inverse_mass.asDiagonal() * Phi_q.transpose();
  Eigen::SparseMatrix<double> normal = Phi_q * weighted;
  // Redundant joints make the matrix singular; the shift allows for them, and they are reported afterwards.
  const double shift = kRegularisation * normal.diagonal().maxCoeff();
  for (Eigen::Index i = 0; i < normal.rows(); ++i) normal.coeffRef(i, i) += shift;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return -(weighted * factor.solve(residual));
}

// Moves the bodies until the joints are closed; the masses are those of the start.
// @param[in,out] terms  at the positions q   @return the largest residual
double close_joints(SystemTerms& terms, Eigen::VectorXd& q) {
  const Model& model = terms.model();
  terms.update_mass();
  const Eigen::VectorXd inverse_mass = make_reluctant_masses(terms);
  Eigen::VectorXd phi = Eigen::VectorXd::Zero(model.num_constraints);
  const auto calc_size = [&] {
    terms.calc_residual(phi);
    return model.num_constraints > 0 ? phi.lpNorm<Eigen::Infinity>() : 0.0;
  };
  double size = calc_size();
  for (int iteration = 0; size > std::max(kClosingTolerance * model.length_scale, model.calc_rounding(q));
       ++iteration) {
    if (iteration == kMaxClosingIterations) throw_cannot_close(model, phi);
    terms.update_jacobian();
    std::optional<Eigen::VectorXd> step = find_least_change(terms, inverse_mass, phi);
    if (!step) throw_cannot_close(model, phi);
    const double largest = model.largest_natural(*step);
    if (largest > 0.3) *step *= 0.3 / largest;  // far from closed, small steps stay on the right branch
    q += *step;
    terms.update_positions(0.0, q);
    size = calc_size();
  }
  return size;
}

}  // namespace

std::string AssemblyReport::describe_shift() const {
  if (shift == 0.0) return {};
  return fmt::format("Shifted as a whole by {:.4g} m, to where its prescribed motion begins\n", shift);
}

AssemblyReport assemble_positions(const Model& model, Eigen::VectorXd& q) {
  AssemblyReport report;
  report.shift = place_driven_vehicles(model, q);
  SystemTerms terms(model);
  terms.update_positions(0.0, q);
  std::vector<Eigen::Vector2d> start;
  for (const MarkerState& marker : terms.markers()) start.push_back(marker.r);
  Eigen::VectorXd phi = Eigen::VectorXd::Zero(model.num_constraints);
  terms.calc_residual(phi);
  find_widest_gap(model, phi, report);
  find_widest_motion_gap(model, phi, report);

  report.residual = close_joints(terms, q);
  terms.update_jacobian();
  terms.update_mass();
  const std::vector<int> dependent = find_dependent_constraints(terms);
  if (!dependent.empty()) throw_redundant(terms, dependent);

  for (std::size_t i = 0; i < start.size(); ++i) {
    const double movement = (terms.markers()[i].r - start[i]).norm();
    if (movement > report.largest_movement) {
      report.largest_movement = movement;
      report.moved_marker = model.markers[i].name;
    }
  }
  return report;
}

VelocityReport project_velocities(const Model& model, double time, const Eigen::VectorXd& q,
                                  Eigen::VectorXd& v, ModalRates modal_rates) {
  VelocityReport report;
  if (model.num_constraints == 0) return report;
  const Eigen::VectorXd asked = v;
  ConstrainedEquations equations(model, SystemTerms::Markers::kActing);
  equations.terms().update_positions(time, q);
  equations.terms().update_jacobian();
  if (modal_rates == ModalRates::kIfNecessary && model.has_modes()) {
    equations.terms().update_mass();
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(model.num_constraints);
    equations.terms().calc_time_rate(residual);
    equations.terms().jacobian().add_product(v, residual);
    const Eigen::VectorXd inverse_mass = make_reluctant_masses(equations.terms());
    if (const auto change = find_least_change(equations.terms(), inverse_mass, residual)) v += *change;
  }
  if (!std::isfinite(equations.close_rates(v))) {
    throw support::NumericalError(fmt::format(
        "the joints allow no velocities at t = {:.9g} s: a singular position; start slightly away from it",
        time));
  }
  v = equations.v();
  for (int i = 0; i < model.num_coordinates; ++i) {
    const double relative = std::abs(v[i] - asked[i]) / model.coordinate_scale(i);
    if (relative <= report.largest_change) continue;
    report = {relative, model.coordinate_name(i)};
  }
  return report;
}

}  // namespace sprung::dynamics

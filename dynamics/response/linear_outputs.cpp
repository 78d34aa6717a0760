#include "dynamics/response/linear_outputs.h"
#include "tools/support/dense/dense_solvers.h"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

using Kind = OutputSubject::Kind;
using Derivative = OutputSubject::Derivative;

constexpr std::array<const char*, 3> kComponents{"x", "y", "angle"};
constexpr std::array<const char*, 3> kDerivatives{"displacement", "velocity",
                                                  "acceleration"};  // as Derivative

// p outputs without names, all zero.
LinearOutputs make_empty(const LinearVehicle& vehicle, Eigen::Index p) {
  const Eigen::Index f = vehicle.system().mass.rows();
  LinearOutputs outputs;
  outputs.by_position = outputs.by_velocity = outputs.by_acceleration = Eigen::MatrixXd::Zero(p, f);
  outputs.by_force = Eigen::MatrixXd::Zero(p, vehicle.model().num_coordinates);
  outputs.by_load = Eigen::MatrixXd::Zero(p, 3 * static_cast<Eigen::Index>(vehicle.model().markers.size()));
  outputs.channels.assign(static_cast<std::size_t>(p), -1);
  return outputs;
}

// Adds a motion, 3×f, as displacement, velocity or acceleration in the rows from `row` on.
void add_motion(LinearOutputs& outputs, Eigen::Index row, std::size_t derivative,
                const Eigen::MatrixXd& motion, const std::string& group, OutputSubject subject) {
  static constexpr std::array<const char*, 3> kSuffixes{"", "/s", "/s^2"};
  for (std::size_t c = 0; c < 3; ++c) {
    outputs.names.push_back(fmt::format("{}/{}.{}", group, kDerivatives[derivative], kComponents[c]));
    outputs.units.push_back(fmt::format("{}{}", c == 2 ? "rad" : "m", kSuffixes[derivative]));
    subject.derivative = static_cast<Derivative>(derivative);
    subject.component = static_cast<int>(c);
    outputs.subjects.push_back(subject);
  }
  Eigen::MatrixXd& target = derivative == 0   ? outputs.by_position
                            : derivative == 1 ? outputs.by_velocity
                                              : outputs.by_acceleration;
  target.middleRows(row, 3) = motion;
}

Eigen::VectorXd calc_channels(const PartitionedEquations& equations, std::span<const int> branches) {
  const Model& model = equations.terms().model();
  std::vector<double> values;
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    const std::size_t first = values.size();
    values.resize(first + force.channels().size());
    force.calc_channels(equations.terms().instant_of(f), model.branches_of(f, branches),
                        std::span(values).subspan(first));
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Force and torque of the joints on their points a, −Gaᵀ λ, for given multipliers: 3 for each joint.
Eigen::VectorXd calc_reactions(const PartitionedEquations& equations, const Eigen::VectorXd& multipliers) {
  const Model& model = equations.terms().model();
  const std::span<const MarkerState> markers = equations.terms().markers();
  Eigen::VectorXd reactions(3 * static_cast<Eigen::Index>(model.joints.size()));
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = *model.joints[j];
    JointJacobian Ga, Gb;
    joint.calc_jacobian(markers[static_cast<std::size_t>(joint.marker_a)],
                        markers[static_cast<std::size_t>(joint.marker_b)], Ga, Gb);
    reactions.segment<3>(3 * static_cast<Eigen::Index>(j)) =
        -Ga.transpose() * multipliers.segment(model.joint_rows[j], joint.num_constraints());
  }
  return reactions;
}

// Those of a model with massless bodies: from the matrix of (system, eq. 1) as a whole.
ForceEffects solve_force_effects(const SystemTerms& terms) {
  const Eigen::Index n = terms.model().num_coordinates, m = terms.model().num_constraints;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + m, n + m);
  for (std::size_t b = 0; b < terms.model().bodies.size(); ++b) {
    const Body& body = terms.model().bodies[b];
    const int first = body.first_coordinate, size = body.num_coordinates();
    whole.block(first, first, size, size) = terms.mass(b);
  }
  whole.diagonal().segment(terms.model().first_state(), terms.model().num_states()).setOnes();
  whole.bottomLeftCorner(m, n) = terms.jacobian().dense();
  whole.topRightCorner(n, m) = whole.bottomLeftCorner(m, n).transpose();
  const Eigen::MatrixXd solution = support::solve_lu(whole, Eigen::MatrixXd::Identity(n + m, n));
  return {.accelerations = solution.topRows(n), .multipliers = solution.bottomRows(m)};
}

// M⁻¹ A, body by body.
Eigen::MatrixXd divide_by_mass(const SystemTerms& terms, Eigen::MatrixXd A) {
  for (std::size_t b = 0; b < terms.model().bodies.size(); ++b) {
    const Body& body = terms.model().bodies[b];
    auto rows = A.middleRows(body.first_coordinate, body.num_coordinates());
    rows = support::solve_positive_definite(terms.mass(b), rows);
  }
  return A;
}

// Derivatives of p values of the state with respect to the vehicle's independent coordinates: p×f each.
void differentiate(const LinearVehicle& vehicle, const StateFunction& function, Eigen::MatrixXd& by_position,
                   Eigen::MatrixXd& by_velocity) {
  PartitionedEquations equations(vehicle.model());
  equations.set_rate_slopes(list_rate_slopes(vehicle.random_laws()));
  equations.choose_partition_at(0.0, vehicle.positions());  // as the linearisation did
  const Eigen::VectorXd q_i = vehicle.independent_positions();
  calc_static_force(equations, 0.0, q_i);
  by_velocity = differentiate_by_velocity(equations, function);
  by_position = differentiate_by_position(equations, 0.0, q_i, function).value;
}

bool is_quantity(const Channel& channel) {
  return channel.role != ChannelRole::kContact && channel.role != ChannelRole::kRoadHeight;
}

}  // namespace

// ∂λ/∂Q = (φ_q M⁻¹ φ_qᵀ)⁻¹ φ_q M⁻¹, ∂q̈/∂Q = M⁻¹ (1 − φ_qᵀ ∂λ/∂Q) (system, eq. 6).
ForceEffects calc_force_effects(const LinearVehicle& vehicle) {
  const SystemTerms& terms = vehicle.equations().terms();
  if (terms.model().has_massless_bodies) return solve_force_effects(terms);
  const Eigen::MatrixXd Phi_q = terms.jacobian().dense();
  const Eigen::MatrixXd by_multipliers = divide_by_mass(terms, Phi_q.transpose());
  const Eigen::MatrixXd S = Phi_q * by_multipliers;
  const Eigen::Index nq = Phi_q.cols();
  ForceEffects effects{.accelerations = divide_by_mass(terms, Eigen::MatrixXd::Identity(nq, nq)),
                       .multipliers = support::solve_positive_definite(S, by_multipliers.transpose())};
  effects.accelerations -= by_multipliers * effects.multipliers;
  return effects;
}

LinearOutputs make_state_outputs(const LinearVehicle& vehicle, const StateFunction& function) {
  Eigen::MatrixXd by_position, by_velocity;
  differentiate(vehicle, function, by_position, by_velocity);
  LinearOutputs outputs = make_empty(vehicle, by_position.rows());
  outputs.by_position = std::move(by_position);
  outputs.by_velocity = std::move(by_velocity);
  return outputs;
}

void LinearOutputs::append(const LinearOutputs& other) {
  names.insert(names.end(), other.names.begin(), other.names.end());
  units.insert(units.end(), other.units.begin(), other.units.end());
  subjects.insert(subjects.end(), other.subjects.begin(), other.subjects.end());
  channels.insert(channels.end(), other.channels.begin(), other.channels.end());
  const auto put_below = [](Eigen::MatrixXd& upper, const Eigen::MatrixXd& lower) {
    const Eigen::Index rows = upper.rows();
    upper.conservativeResize(rows + lower.rows(), lower.cols());
    upper.bottomRows(lower.rows()) = lower;
  };
  put_below(by_position, other.by_position);
  put_below(by_velocity, other.by_velocity);
  put_below(by_acceleration, other.by_acceleration);
  put_below(by_force, other.by_force);
  put_below(by_load, other.by_load);
}

LinearOutputs LinearOutputs::pick(const std::vector<int>& rows) const {
  LinearOutputs picked{.names = {},
                       .units = {},
                       .subjects = {},
                       .by_position = by_position(rows, Eigen::all),
                       .by_velocity = by_velocity(rows, Eigen::all),
                       .by_acceleration = by_acceleration(rows, Eigen::all),
                       .by_force = by_force(rows, Eigen::all),
                       .by_load = by_load(rows, Eigen::all),
                       .channels = {}};
  for (const int row : rows) {
    const auto i = static_cast<std::size_t>(row);
    picked.names.push_back(names[i]);
    picked.units.push_back(units[i]);
    picked.subjects.push_back(subjects[i]);
    picked.channels.push_back(channels[i]);
  }
  return picked;
}

LinearOutputs make_point_outputs(const LinearVehicle& vehicle, int marker) {
  const Eigen::MatrixXd motion =
      calc_marker_jacobian(vehicle.equations().terms(), marker) * vehicle.system().directions;
  LinearOutputs outputs = make_empty(vehicle, 9);
  const std::string group = "points/" + vehicle.model().markers[static_cast<std::size_t>(marker)].name;
  for (std::size_t derivative = 0; derivative < 3; ++derivative) {
    add_motion(outputs, 3 * static_cast<Eigen::Index>(derivative), derivative, motion, group,
               {.kind = Kind::kPoint, .object = marker});
  }
  return outputs;
}

LinearOutputs make_modal_outputs(const LinearVehicle& vehicle) {
  LinearOutputs outputs = make_empty(vehicle, 0);
  for (std::size_t b = 0; b < vehicle.model().bodies.size(); ++b) {
    const Body& body = vehicle.model().bodies[b];
    LinearOutputs one = make_empty(vehicle, 2 * body.num_modes());
    for (int k = 0; k < body.num_modes(); ++k) {
      const Eigen::RowVectorXd row = vehicle.system().directions.row(body.first_coordinate + 3 + k);
      one.names.push_back(fmt::format("bodies/{}/modal/amplitude.{}", body.name, k + 1));
      one.names.push_back(fmt::format("bodies/{}/modal/acceleration.{}", body.name, k + 1));
      one.units.insert(one.units.end(), {"kg^0.5 m", "kg^0.5 m/s^2"});
      for (const Derivative derivative : {Derivative::kDisplacement, Derivative::kAcceleration}) {
        one.subjects.push_back(
            {.kind = Kind::kMode, .object = static_cast<int>(b), .derivative = derivative, .component = k});
      }
      one.by_position.row(2 * k) = row;
      one.by_acceleration.row(2 * k + 1) = row;
    }
    outputs.append(one);
  }
  return outputs;
}

LinearOutputs make_force_outputs(const LinearVehicle& vehicle) {
  Eigen::MatrixXd by_position, by_velocity;
  differentiate(vehicle, calc_channels, by_position, by_velocity);
  std::vector<int> rows;
  std::vector<std::string> names, units;
  std::vector<OutputSubject> subjects;
  for (std::size_t f = 0; f < vehicle.model().forces.size(); ++f) {
    const ForceElement& force = *vehicle.model().forces[f];
    for (std::size_t c = 0; c < force.channels().size(); ++c) {
      const Channel& channel = force.channels()[c];
      if (!is_quantity(channel)) continue;
      rows.push_back(vehicle.channel_rows()[f] + static_cast<int>(c));
      names.push_back(fmt::format("forces/{}/{}", force.name, channel.name));
      units.emplace_back(channel.unit);
      subjects.push_back({.kind = Kind::kChannel, .object = static_cast<int>(f), .role = channel.role});
    }
  }
  LinearOutputs outputs = make_empty(vehicle, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    outputs.by_position.row(static_cast<Eigen::Index>(i)) = by_position.row(rows[i]);
    outputs.by_velocity.row(static_cast<Eigen::Index>(i)) = by_velocity.row(rows[i]);
  }
  outputs.channels = std::move(rows);
  outputs.names = std::move(names);
  outputs.units = std::move(units);
  outputs.subjects = std::move(subjects);
  return outputs;
}

LinearOutputs make_reaction_outputs(const LinearVehicle& vehicle) {
  const StateFunction reactions = [](const PartitionedEquations& at, std::span<const int> /*branches*/) {
    return calc_reactions(at, at.multipliers());
  };
  const auto num_joints = static_cast<Eigen::Index>(vehicle.model().joints.size());
  if (num_joints == 0) return make_empty(vehicle, 0);
  LinearOutputs outputs = make_state_outputs(vehicle, reactions);
  const Eigen::MatrixXd multipliers = calc_force_effects(vehicle).multipliers;
  for (Eigen::Index i = 0; i < multipliers.cols(); ++i) {
    outputs.by_force.col(i) = calc_reactions(vehicle.equations(), multipliers.col(i));
  }
  static constexpr std::array<const char*, 3> kReactions{"x", "y", "torque"};
  for (std::size_t j = 0; j < vehicle.model().joints.size(); ++j) {
    for (std::size_t c = 0; c < 3; ++c) {
      outputs.names.push_back(
          fmt::format("joints/{}/reaction.{}", vehicle.model().joints[j]->name, kReactions[c]));
      outputs.units.emplace_back(c == 2 ? "N m" : "N");
      outputs.subjects.push_back(
          {.kind = Kind::kReaction, .object = static_cast<int>(j), .component = static_cast<int>(c)});
    }
  }
  return outputs;
}

Eigen::MatrixXcd sum_outputs(const LinearOutputs& outputs, double omega, const Eigen::MatrixXcd& x,
                             const Eigen::MatrixXcd& forces, const Eigen::MatrixXcd& channels) {
  const std::complex<double> s(0.0, omega);
  const Eigen::MatrixXcd by_motion =
      outputs.by_position + s * outputs.by_velocity + (s * s) * outputs.by_acceleration;
  Eigen::MatrixXcd y = by_motion * x + outputs.by_force * forces;
  for (std::size_t i = 0; i < outputs.channels.size(); ++i) {
    if (outputs.channels[i] >= 0) y.row(static_cast<Eigen::Index>(i)) += channels.row(outputs.channels[i]);
  }
  return y;
}

Eigen::MatrixXcd calc_transfer(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                               const RoadWave& wave) {
  const RoadAction action = vehicle.calc_road_action(wave);
  const Eigen::MatrixXcd x = vehicle.calc_motion(wave.frequency, action);
  return sum_outputs(outputs, wave.frequency, x, action.forces, action.channels);
}

Eigen::VectorXcd calc_response(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                               const RoadWave& wave) {
  return calc_transfer(vehicle, outputs, wave) * vehicle.calc_delays(wave);
}

RoadWave make_road_wave(double frequency_hz, double speed) {
  if (!(frequency_hz > 0.0) || !(speed > 0.0)) {
    throw std::invalid_argument(fmt::format(
        "make_road_wave: frequency and speed must be > 0, got {} Hz and {} m/s", frequency_hz, speed));
  }
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  return {.wavenumber = omega / speed, .frequency = omega};
}

}  // namespace sprung::dynamics

#include "dynamics/system/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

// Sets what stands in for masses and inertias of 0: a millionth of the smallest mass, but at least so much of
// the median one that arithmetic of 16 digits can do with it. And the least metric, a share of the mean mass.
void set_stand_ins(Model& model) {
  constexpr double kShare = 1e-6, kLightest = 1e-9;
  std::vector<double> masses;
  for (const Body& body : model.bodies) {
    if (body.mass > 0.0) masses.push_back(body.mass);
  }
  std::sort(masses.begin(), masses.end());
  if (masses.empty()) masses = {1.0};
  const double mean = std::reduce(masses.begin(), masses.end()) / static_cast<double>(masses.size());
  const double mass = kShare * std::max(masses.front(), kShare * masses[masses.size() / 2]);
  const double squared_length = model.length_scale * model.length_scale;
  model.has_massless_bodies = model.has_light_bodies = false;
  for (Body& body : model.bodies) {
    body.stand_in_mass = body.mass > 0.0 ? 0.0 : mass;
    body.stand_in_inertia = body.second_moment > 0.0 ? 0.0 : mass * squared_length;
    body.least_metric = Eigen::Vector3d(1.0, 1.0, squared_length) * (kLightest * mean);
    model.has_massless_bodies |= body.stand_in_mass > 0.0 || body.stand_in_inertia > 0.0;
    model.has_light_bodies |= body.mass < body.least_metric.x() || body.second_moment < body.least_metric.z();
  }
}

void collect_time_functions(Model& model) {
  model.has_moving_joints = false;
  model.time_breaks.clear();
  model.time_details = DetailLengths();
  const auto add = [&](const std::vector<const TimeFunction*>& functions) {
    for (const TimeFunction* function : functions) {
      model.time_breaks.insert(model.time_breaks.end(), function->breaks().begin(), function->breaks().end());
      model.time_details = DetailLengths::shorter(model.time_details, function->details());
    }
  };
  for (const auto& joint : model.joints) {
    add(joint->time_functions());
    model.has_moving_joints |= !joint->time_functions().empty();
  }
  for (const auto& force : model.forces) add(force->time_functions());
  std::sort(model.time_breaks.begin(), model.time_breaks.end());
  model.time_breaks.erase(std::unique(model.time_breaks.begin(), model.time_breaks.end()),
                          model.time_breaks.end());
}

// The largest distance of a marker from its body's frame; where all are at frames, the largest distance of
// two places on the ground at which joints and forces act; else 1 m.
double find_length_scale(const Model& model) {
  double extent = 0.0;
  for (const Marker& marker : model.markers) {
    if (marker.body != kGround) extent = std::max(extent, marker.p_BP.norm());
  }
  if (extent > 0.0) return extent;
  const Marker* first = nullptr;
  for (const int acting : model.acting_markers) {
    const Marker& marker = model.markers[static_cast<std::size_t>(acting)];
    if (marker.body != kGround) continue;
    if (first == nullptr) first = &marker;
    extent = std::max(extent, (marker.p_BP - first->p_BP).norm());
  }
  return extent > 0.0 ? extent : 1.0;
}

}  // namespace

BodyCoordinate Model::body_coordinate(int coordinate) const {
  if (coordinate < 0 || coordinate >= num_coordinates) {
    throw std::invalid_argument(fmt::format("Model: coordinate {} of {}", coordinate, num_coordinates));
  }
  if (coordinate >= first_state()) return {.body = -1, .local = -1};
  const auto behind = std::upper_bound(bodies.begin(), bodies.end(), coordinate,
                                       [](int i, const Body& body) { return i < body.first_coordinate; });
  const auto body = std::prev(behind);
  return {.body = static_cast<int>(body - bodies.begin()), .local = coordinate - body->first_coordinate};
}

std::string Model::coordinate_name(int coordinate) const {
  const auto [index, local] = body_coordinate(coordinate);
  if (index < 0) {
    const int state = coordinate - first_state();
    const auto behind = std::upper_bound(force_states.begin(), force_states.end(), state);
    const auto f = static_cast<std::size_t>(behind - force_states.begin() - 1);
    return fmt::format("{}.{}", forces[f]->name, states[static_cast<std::size_t>(state)].name);
  }
  const Body& body = bodies[static_cast<std::size_t>(index)];
  if (local < 3) return fmt::format("{}.{}", body.name, local == 0 ? "x" : local == 1 ? "y" : "angle");
  return fmt::format("{}.mode {}", body.name, body.mode_numbers[static_cast<std::size_t>(local - 3)]);
}

bool Model::has_modes() const {
  return std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.num_modes() > 0; });
}

double Model::coordinate_scale(int coordinate) const {
  const auto [body, local] = body_coordinate(coordinate);
  if (body < 0) {
    const InternalState& state = states[static_cast<std::size_t>(coordinate - first_state())];
    return state.is_per_length ? state.size * length_scale : state.size;
  }
  if (local < 2) return length_scale;
  return local == 2 ? 1.0 : length_scale / bodies[static_cast<std::size_t>(body)].mode_scale[local - 3];
}

double Model::largest_natural(const Eigen::VectorXd& values) const {
  double largest = 0.0;
  for (int i = 0; i < num_coordinates; ++i)
    largest = std::max(largest, std::abs(values[i]) / coordinate_scale(i));
  return largest;
}

double Model::calc_rounding(const Eigen::VectorXd& q) const {
  constexpr double kUnits = 4.0 * std::numeric_limits<double>::epsilon();
  double place = 0.0, angle = 0.0;
  for (const Body& body : bodies) {
    const int i = body.first_coordinate;
    place = std::max({place, std::abs(q[i]), std::abs(q[i + 1])});
    angle = std::max(angle, std::abs(q[i + 2]));
  }
  return kUnits * (place + std::max(length_scale, 1.0) * angle);
}

int Model::find_body(const std::string& name) const {
  const auto found =
      std::find_if(bodies.begin(), bodies.end(), [&](const Body& body) { return body.name == name; });
  return found == bodies.end() ? -1 : static_cast<int>(found - bodies.begin());
}

int Model::find_marker(const std::string& name) const {
  const auto found =
      std::find_if(markers.begin(), markers.end(), [&](const Marker& marker) { return marker.name == name; });
  return found == markers.end() ? -1 : static_cast<int>(found - markers.begin());
}

Eigen::MatrixXd apply_modal_stiffness(const Model& model, const Eigen::MatrixXd& x, bool of_sizes) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  for (const Body& body : model.bodies) {
    const Eigen::Index first = body.first_coordinate + 3, n = body.num_modes();
    if (n == 0) continue;
    if (of_sizes) {
      product.middleRows(first, n) = body.stiffness.cwiseAbs() * x.middleRows(first, n);
    } else {
      product.middleRows(first, n) = body.stiffness * x.middleRows(first, n);
    }
  }
  return product;
}

void number_model(Model& model) {
  model.num_coordinates = 0;
  for (Body& body : model.bodies) {
    body.first_coordinate = model.num_coordinates;
    model.num_coordinates += body.num_coordinates();
  }
  model.num_constraints = 0;
  model.joint_rows.clear();
  for (const auto& joint : model.joints) {
    model.joint_rows.push_back(model.num_constraints);
    model.num_constraints += joint->num_constraints();
  }
  model.num_branches = 0;
  model.force_branches.clear();
  for (const auto& force : model.forces) {
    model.force_branches.push_back(model.num_branches);
    model.num_branches += force->num_branches();
  }
  model.states.clear();
  model.force_states.assign(1, 0);
  for (const auto& force : model.forces) {
    for (InternalState& state : force->internal_states()) model.states.push_back(std::move(state));
    model.force_states.push_back(model.num_states());
  }
  model.num_coordinates += model.num_states();
  std::set<int> acting;
  for (const auto& joint : model.joints) acting.insert({joint->marker_a, joint->marker_b});
  for (const auto& force : model.forces) {
    for (const int marker : force->markers()) acting.insert(marker);
  }
  model.acting_markers.assign(acting.begin(), acting.end());
  collect_time_functions(model);
  model.length_scale = find_length_scale(model);
  set_stand_ins(model);
}

}  // namespace sprung::dynamics

#include "dynamics/system/held_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

// Local mode indices of a body.
struct Split {
  std::vector<int> active, held;
  Eigen::VectorXd eta;  // of those held
};

Split split_modes(const Body& body, const std::vector<bool>& is_active, const Eigen::VectorXd& q) {
  Split split;
  std::vector<double> values;
  for (int k = 0; k < body.num_modes(); ++k) {
    const int coordinate = body.first_coordinate + 3 + k;
    if (is_active[static_cast<std::size_t>(coordinate)]) {
      split.active.push_back(k);
    } else {
      split.held.push_back(k);
      values.push_back(q[coordinate]);
    }
  }
  split.eta = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  return split;
}

void require_uncoupled(const Body& body, const Split& split) {
  for (const int a : split.active) {
    for (const int h : split.held) {
      const double size = std::sqrt(std::abs(body.stiffness(a, a) * body.stiffness(h, h)));
      if (std::abs(body.stiffness(a, h)) > 1e-9 * size) {
        throw std::invalid_argument(
            fmt::format("hold_modes: modes {} and {} of '{}' are coupled by stiffness",
                        body.mode_numbers[static_cast<std::size_t>(a)],
                        body.mode_numbers[static_cast<std::size_t>(h)], body.name));
      }
    }
  }
}

// Invariants of the deformed body: those of the undeformed one, developed about the deformation held.
Body hold(const Body& full, const Split& split) {
  const auto& [active, held, eta] = split;
  Body body;
  body.name = full.name;
  body.mass = full.mass;
  body.first_moment = full.first_moment + full.P(Eigen::all, held) * eta;
  body.second_moment =
      full.second_moment + 2.0 * full.d(held).dot(eta) + eta.dot(full.M_tt(held, held) * eta);
  body.P = full.P(Eigen::all, active);
  body.c = full.c(active) + eta.transpose() * full.B(held, active);
  body.d = full.d(active) + eta.transpose() * full.M_tt(held, active);
  body.M_ff = full.M_ff(active, active);
  body.modal_mass = full.modal_mass(active);
  body.M_tt = full.M_tt(active, active);
  body.B = full.B(active, active);
  body.stiffness = full.stiffness(active, active);
  body.damping = full.damping(active, active);
  body.mode_scale = full.mode_scale(active);
  for (const int k : active) body.mode_numbers.push_back(full.mode_numbers[static_cast<std::size_t>(k)]);
  return body;
}

// Internal states of force elements are always there.
void append_states(const Model& full, std::vector<int>& coordinates) {
  for (int i = full.first_state(); i < full.num_coordinates; ++i) coordinates.push_back(i);
}

}  // namespace

HeldModes hold_modes(const Model& full, const std::vector<bool>& is_active, const Eigen::VectorXd& q) {
  HeldModes result;
  Model& model = result.model;
  std::vector<Split> splits;
  for (const Body& body : full.bodies) {
    splits.push_back(split_modes(body, is_active, q));
    require_uncoupled(body, splits.back());
    model.bodies.push_back(hold(body, splits.back()));
    for (int k = 0; k < 3; ++k) result.coordinates.push_back(body.first_coordinate + k);
    for (const int k : splits.back().active) result.coordinates.push_back(body.first_coordinate + 3 + k);
  }
  append_states(full, result.coordinates);
  for (const Marker& marker : full.markers) {
    model.markers.push_back(marker);
    if (marker.body == kGround) continue;
    const Split& split = splits[static_cast<std::size_t>(marker.body)];
    Marker& held = model.markers.back();
    const Eigen::Vector3d bent = marker.Phi(Eigen::all, split.held) * split.eta;
    held.p_BP += bent.head<2>();
    held.alpha_BP += bent[2];
    held.Phi = marker.Phi(Eigen::all, split.active);
  }
  model.joints = full.joints;
  model.forces = full.forces;
  model.gravity = full.gravity;
  number_model(model);
  model.length_scale = full.length_scale;
  return result;
}

HeldModes match_modes(const Model& model, const Model& full) {
  HeldModes result;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = full.bodies[b];
    for (int k = 0; k < 3; ++k) result.coordinates.push_back(body.first_coordinate + k);
    for (const int number : model.bodies[b].mode_numbers) {
      const auto found = std::lower_bound(body.mode_numbers.begin(), body.mode_numbers.end(), number);
      if (found == body.mode_numbers.end() || *found != number) {
        throw std::invalid_argument(fmt::format("match_modes: '{}' has no mode {}", body.name, number));
      }
      result.coordinates.push_back(body.first_coordinate + 3 +
                                   static_cast<int>(found - body.mode_numbers.begin()));
    }
  }
  append_states(full, result.coordinates);
  return result;
}

Eigen::VectorXd select_active(const HeldModes& held, const Eigen::VectorXd& full) {
  return full(held.coordinates);
}

void put_active(const HeldModes& held, const Eigen::VectorXd& active, Eigen::VectorXd& full) {
  for (std::size_t i = 0; i < held.coordinates.size(); ++i) {
    full[held.coordinates[i]] = active[static_cast<Eigen::Index>(i)];
  }
}

}  // namespace sprung::dynamics

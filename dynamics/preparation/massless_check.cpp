#include "dynamics/preparation/massless_check.h"

#include <fmt/format.h>

#include <optional>

#include "dynamics/linear/massless_motion.h"
#include "tools/support/errors/input_error.h"

namespace sprung::dynamics {

void check_massless_bodies(const Vehicle& vehicle, const Model& model, const Eigen::VectorXd& q) {
  const std::optional<int> found = find_massless_motion(model, q);
  if (!found) return;
  const BodyCoordinate coordinate = model.body_coordinate(*found);
  const BodyDescription& body = vehicle.bodies[static_cast<std::size_t>(coordinate.body)];
  const bool is_angle = coordinate.local == 2;
  throw support::InputError(
      is_angle ? body.inertia_location : body.mass_location,
      fmt::format(
          "'bodies.{}' can move without moving any mass ('{}' is free), so that no acceleration follows "
          "from its forces; give it {}, or a joint that holds it",
          body.name, model.coordinate_name(*found), is_angle ? "an inertia" : "a mass"));
}

}  // namespace sprung::dynamics

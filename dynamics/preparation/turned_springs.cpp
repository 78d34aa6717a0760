#include "dynamics/preparation/turned_springs.h"

#include <Eigen/Geometry>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

namespace {

// Directions from a to b, in the axes of the bodies of a and of b.
struct Directions {
  Eigen::Vector2d seen_from_a, seen_from_b;
};

Directions find_directions(const SystemTerms& terms, const ForceElement& force) {
  const std::vector<int> markers = force.markers();
  const MarkerState& a = terms.markers()[static_cast<std::size_t>(markers[0])];
  const MarkerState& b = terms.markers()[static_cast<std::size_t>(markers[1])];
  const Eigen::Vector2d direction = b.r - a.r;
  return {Eigen::Rotation2Dd(-a.angle) * direction, Eigen::Rotation2Dd(-b.angle) * direction};
}

}  // namespace

std::vector<std::size_t> find_turned_springs(const Vehicle& vehicle, const Model& model,
                                             const Eigen::VectorXd& drawn, const Eigen::VectorXd& found) {
  SystemTerms before(model), after(model);
  before.update_positions(0.0, drawn);
  after.update_positions(0.0, found);
  std::vector<std::size_t> turned;
  for (std::size_t f = 0; f < vehicle.forces.size(); ++f) {
    if (!vehicle.forces[f].along_line) continue;
    const Directions old_ones = find_directions(before, *model.forces[f]);
    const Directions new_ones = find_directions(after, *model.forces[f]);
    if (old_ones.seen_from_a.dot(new_ones.seen_from_a) < 0.0 ||
        old_ones.seen_from_b.dot(new_ones.seen_from_b) < 0.0) {
      turned.push_back(f);
    }
  }
  return turned;
}

}  // namespace sprung::dynamics

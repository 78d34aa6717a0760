#include "dynamics/adaptivity/full_small_motion.h"

#include <algorithm>

#include "dynamics/system/partitioned_equations.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

FullSmallMotion::FullSmallMotion(const Model& full, double time, const Eigen::VectorXd& q,
                                 const std::vector<int>& points, const LinearisedSystem* linearised)
    : full_(&full) {
  for (const Body& body : full.bodies) {
    for (int k = 0; k < body.num_modes(); ++k) modal_.push_back(body.first_coordinate + 3 + k);
  }
  Eigen::MatrixXd directions;
  try {
    std::optional<LinearisedSystem> found;
    if (!linearised) {
      PartitionedEquations equations(full);
      linearised = &found.emplace(linearise(equations, time, q));
    }
    independent_ = linearised->partition.independent;
    motion_ = {linearised->mass, linearised->damping, linearised->stiffness};
    directions = linearised->directions;
  } catch (const support::NumericalError&) {
    // Near a singular position: no small motion.
  }

  SystemTerms terms(full);
  terms.update_positions(time, q);
  for (const int i : points) {
    const Marker& marker = full.markers[static_cast<std::size_t>(i)];
    Eigen::Matrix2Xd motion = Eigen::Matrix2Xd::Zero(2, full.num_coordinates);
    if (marker.body != kGround) {
      const Body& body = full.bodies[static_cast<std::size_t>(marker.body)];
      const MarkerState& state = terms.markers()[static_cast<std::size_t>(i)];
      motion.block<2, 2>(0, body.first_coordinate).setIdentity();
      motion.col(body.first_coordinate + 2) = state.r_theta;
      motion.middleCols(body.first_coordinate + 3, body.num_modes()) = state.r_eta();
    }
    point_motion_.push_back(motion);
    reduced_motion_.emplace_back(2, directions.cols());
    if (!independent_.empty()) reduced_motion_.back() = motion * directions;
  }
}

Eigen::Index FullSmallMotion::find_independent(int coordinate) const {
  const auto found = std::lower_bound(independent_.begin(), independent_.end(), coordinate);
  return found == independent_.end() || *found != coordinate ? -1 : found - independent_.begin();
}

std::vector<Eigen::Index> FullSmallMotion::find_free(const std::vector<bool>& is_active) const {
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    const auto found = std::lower_bound(modal_.begin(), modal_.end(), independent_[i]);
    const bool is_modal = found != modal_.end() && *found == independent_[i];
    if (!is_modal || is_active[static_cast<std::size_t>(found - modal_.begin())])
      free.push_back(static_cast<Eigen::Index>(i));
  }
  return free;
}

std::optional<KnownMotion> FullSmallMotion::calc_held_motion(const HeldModes& held) const {
  KnownMotion known;
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < independent_.size(); ++i) {
    const auto place = std::lower_bound(held.coordinates.begin(), held.coordinates.end(), independent_[i]);
    if (place == held.coordinates.end() || *place != independent_[i]) continue;
    free.push_back(static_cast<Eigen::Index>(i));
    known.independent.push_back(static_cast<int>(place - held.coordinates.begin()));
  }
  const std::size_t num_held = static_cast<std::size_t>(full_->num_coordinates) - held.coordinates.size();
  if (independent_.empty() || independent_.size() - free.size() != num_held) return std::nullopt;
  known.motion = {motion_.mass(free, free), motion_.damping(free, free), motion_.stiffness(free, free)};
  return known;
}

}  // namespace sprung::dynamics

#include "dynamics/adaptivity/mode_change_ringing.h"

#include <algorithm>

#include "dynamics/adaptivity/ringing.h"

namespace sprung::dynamics {

namespace {

// @param free  places of the coordinates that can vibrate among the independent ones
Ringing make_ringing(const ModeIndicator& indicator, const std::vector<Eigen::Index>& free) {
  const FullSmallMotion& motion = indicator.small_motion();
  const auto& [M, C, K] = motion.motion();
  std::vector<Ringing::Point> points;
  for (std::size_t i = 0; i < motion.num_points(); ++i) {
    points.push_back({motion.reduced_motion(i)(Eigen::all, free), indicator.sizes().acceleration(i)});
  }
  return {{M(free, free), C(free, free), K(free, free)}, points};
}

}  // namespace

double calc_release_time(const ModeIndicator& indicator, const std::vector<int>& coordinates,
                         const std::vector<double>& forces, double share, double longest) {
  const FullSmallMotion& motion = indicator.small_motion();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(motion.motion().mass.rows());
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const Eigen::Index place = motion.find_independent(coordinates[k]);
    if (place < 0) return longest;
    force[place] = forces[k];
  }
  const std::vector<Eigen::Index> free = motion.find_free(indicator.active());
  return make_ringing(indicator, free).calc_release_time(force(free), share, longest);
}

// The momentum M_Aj v_j that a mode has given to the others stays theirs.
std::vector<double> calc_stopping_shares(const ModeIndicator& indicator, const std::vector<int>& coordinates,
                                         const Eigen::VectorXd& v) {
  const FullSmallMotion& motion = indicator.small_motion();
  const std::vector<int>& modal = indicator.modal_coordinates();
  std::vector<double> shares(coordinates.size(), 0.0);
  std::vector<bool> active = indicator.active();
  for (const int i : coordinates)
    active[static_cast<std::size_t>(std::lower_bound(modal.begin(), modal.end(), i) - modal.begin())] = false;
  const std::vector<Eigen::Index> free = motion.find_free(active);
  if (free.empty()) return shares;
  const Ringing ringing = make_ringing(indicator, free);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const Eigen::Index place = motion.find_independent(coordinates[k]);
    if (place < 0) continue;
    shares[k] = ringing.calc_share_of_impulse(motion.motion().mass(free, place) * v[coordinates[k]]);
  }
  return shares;
}

}  // namespace sprung::dynamics

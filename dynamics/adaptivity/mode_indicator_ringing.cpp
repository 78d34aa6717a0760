// What modes leave ringing where they are let go or stopped, as the ModeIndicator foretells it.
#include <algorithm>

#include "dynamics/adaptivity/mode_indicator.h"

namespace sprung::dynamics {

Ringing ModeIndicator::make_ringing(const std::vector<Eigen::Index>& free) const {
  std::vector<Ringing::Point> points;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points.push_back({reduced_motion_[i](Eigen::all, free), largest_acceleration_[i]});
  }
  return {{mass_(free, free), damping_(free, free), stiffness_(free, free)}, points};
}

double ModeIndicator::calc_release_time(const std::vector<int>& coordinates,
                                        const std::vector<double>& forces, double share,
                                        double longest) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(mass_.rows());
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const auto found = std::find(independent_.begin(), independent_.end(), coordinates[k]);
    if (found == independent_.end()) return longest;
    force[found - independent_.begin()] = forces[k];
  }
  const std::vector<Eigen::Index> free = find_free(active_);
  return make_ringing(free).calc_release_time(force(free), share, longest);
}

// The momentum M_Aj v_j that a mode had given to the others stays theirs.
std::vector<double> ModeIndicator::calc_stopping_shares(const std::vector<int>& coordinates,
                                                        const Eigen::VectorXd& v) const {
  std::vector<double> shares(coordinates.size(), 0.0);
  std::vector<bool> active = active_;
  for (const int i : coordinates)
    active[static_cast<std::size_t>(std::lower_bound(modal_.begin(), modal_.end(), i) - modal_.begin())] =
        false;
  const std::vector<Eigen::Index> free = find_free(active);
  if (free.empty()) return shares;
  const Ringing ringing = make_ringing(free);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const auto found = std::find(independent_.begin(), independent_.end(), coordinates[k]);
    if (found == independent_.end()) continue;
    shares[k] = ringing.calc_share_of_impulse(mass_(free, found - independent_.begin()) * v[coordinates[k]]);
  }
  return shares;
}

}  // namespace sprung::dynamics

#include "dynamics/linear/forces_without_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

namespace {

bool is_finite(const Wrench& wrench) {
  return wrench.force.allFinite() && std::isfinite(wrench.torque);
}

// "1.2 m", or more such distances for an element with more than two points.
std::string describe_distances(const SystemTerms& terms, const ForceElement& force) {
  std::string text;
  const std::vector<int> markers = force.markers();
  for (std::size_t i = 0; i + 1 < markers.size(); i += 2) {
    const auto place = [&](int marker) { return terms.markers()[static_cast<std::size_t>(marker)].r; };
    text +=
        fmt::format("{}{:.4g} m", i == 0 ? "" : " and ", (place(markers[i + 1]) - place(markers[i])).norm());
  }
  return text;
}

}  // namespace

std::string describe_forces_without_value(const Model& model, double time, const Eigen::VectorXd& q) {
  SystemTerms terms(model);
  terms.update_positions(time, q);
  terms.update_velocities(Eigen::VectorXd::Zero(model.num_coordinates));
  const std::vector<int> branches = terms.find_branches();
  std::string text;
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    std::vector<Wrench> wrenches(model.markers.size());
    force.add_wrenches(terms.instant_of(f), model.branches_of(f, branches), wrenches);
    if (std::all_of(wrenches.begin(), wrenches.end(), is_finite)) continue;
    const std::string distances = describe_distances(terms, force);
    text += fmt::format("{}'{}'{}", text.empty() ? "" : " and ", force.name,
                        distances.empty() ? "" : fmt::format(" (points {} apart)", distances));
  }
  return text;
}

}  // namespace sprung::dynamics

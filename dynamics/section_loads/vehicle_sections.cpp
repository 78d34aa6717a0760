#include "dynamics/section_loads/vehicle_sections.h"

#include <utility>

namespace sprung::dynamics {

VehicleSections::VehicleSections(const Vehicle& vehicle, const Model& model) : loads_(model.markers.size()) {
  const std::vector<VehiclePoint> points = list_points(vehicle);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const reduce::Superelement* superelement = vehicle.superelement_of(vehicle.bodies[b]);
    // A superelement made from matrices has no elements along which there were loads.
    if (superelement == nullptr || superelement->elements.cols() == 0) continue;
    BodySections sections(model, static_cast<int>(b), *superelement, points);
    if (sections.has_modes() || sections.has_loads()) bodies_.push_back(std::move(sections));
  }
}

void VehicleSections::update(const SystemTerms& terms, const Eigen::VectorXd& lambda,
                             const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                             const Eigen::VectorXd& v_dot) {
  if (bodies_.empty()) return;
  terms.calc_loads(lambda, loads_);
  update(loads_, q, v, v_dot);
}

void VehicleSections::update(std::span<const Wrench> loads, const Eigen::VectorXd& q,
                             const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot) {
  for (BodySections& body : bodies_) body.update(loads, q, v, v_dot);
}

std::vector<BodyBending> make_body_bending(const Vehicle& vehicle, const Model& model,
                                           const VehicleSections& sections) {
  std::vector<BodyBending> bending;
  for (const BodySections& body : sections.bodies()) {
    if (!body.has_modes()) continue;
    bending.emplace_back(model.bodies[body.body()], *vehicle.superelement_of(vehicle.bodies[body.body()]),
                         body.loads());
  }
  return bending;
}

void add_to_bending(const VehicleSections& sections, double time, const Eigen::VectorXd& q,
                    std::vector<BodyBending>& bending) {
  auto next = bending.begin();
  for (const BodySections& body : sections.bodies()) {
    if (body.has_modes()) (next++)->add(time, body.loads(), q);
  }
}

}  // namespace sprung::dynamics

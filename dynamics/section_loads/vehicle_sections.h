#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dynamics/section_loads/body_bending.h"
#include "dynamics/section_loads/body_sections.h"
#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// The sections of all bodies of a vehicle that have a superelement.
class VehicleSections {
 public:
  VehicleSections(const Vehicle& vehicle, const Model& model);

  /// @param terms   positions, Jacobian, velocities and forces up to date; of the model, or of one with some
  ///                of its modes held
  /// @param lambda  multipliers of the terms
  /// @param q, v, v_dot  of the model
  void update(const SystemTerms& terms, const Eigen::VectorXd& lambda, const Eigen::VectorXd& q,
              const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);
  /// Likewise under given loads on each marker of the model, world axes.
  void update(std::span<const Wrench> loads, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
              const Eigen::VectorXd& v_dot);
  const std::vector<BodySections>& bodies() const { return bodies_; }
  /// Force and torque on each marker of the model at the last update, world axes.
  const std::vector<Wrench>& loads() const { return loads_; }

 private:
  std::vector<BodySections> bodies_;
  std::vector<Wrench> loads_;  // on each marker
};

/// The bending of each body with modes, in the order of the sections' bodies.
std::vector<BodyBending> make_body_bending(const Vehicle& vehicle, const Model& model,
                                           const VehicleSections& sections);
/// Adds the present bending. @param sections  up to date at this time and q
void add_to_bending(const VehicleSections& sections, double time, const Eigen::VectorXd& q,
                    std::vector<BodyBending>& bending);

}  // namespace sprung::dynamics

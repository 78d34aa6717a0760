#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// The force elements of a model at rest.
class RestingForces {
 public:
  /// @param model  has to outlive this   @param q  num_coordinates
  RestingForces(const Model& model, const Eigen::VectorXd& q);

  const SystemTerms& terms() const { return terms_; }  ///< positions and velocities at rest
  /// The values of an element's channels, in their order.
  std::vector<double> calc_channels(std::size_t force_index) const;

 private:
  SystemTerms terms_;
  std::vector<int> branches_;
};

}  // namespace sprung::dynamics

#include "dynamics/joints/joint.h"

namespace sprung::dynamics {

void Joint::calc_time_rate(const MarkerState& /*a*/, const MarkerState& /*b*/, double /*time*/,
                           JointVector& phi_t) const {
  phi_t.setZero(num_constraints());
}

}  // namespace sprung::dynamics

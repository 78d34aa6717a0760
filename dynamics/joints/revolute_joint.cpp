#include "dynamics/joints/revolute_joint.h"

namespace sprung::dynamics {

void RevoluteJoint::calc_residual(const MarkerState& a, const MarkerState& b, double /*time*/,
                                  JointVector& phi) const {
  phi = a.r - b.r;
}

void RevoluteJoint::calc_jacobian(const MarkerState& /*a*/, const MarkerState& /*b*/, JointJacobian& Ga,
                                  JointJacobian& Gb) const {
  Ga.setZero(2, 3);
  Ga(0, 0) = Ga(1, 1) = 1.0;
  Gb = -Ga;
}

void RevoluteJoint::calc_drift(const MarkerState& /*a*/, const MarkerState& /*b*/, double /*time*/,
                               JointVector& drift) const {
  drift.setZero(2);
}

}  // namespace sprung::dynamics

#include "dynamics/forces/force_element.h"

namespace sprung::dynamics {

std::string_view role_name(ChannelRole role) {
  switch (role) {
    case ChannelRole::kForce:
      return "force";
    case ChannelRole::kLongitudinalForce:
      return "longitudinal-force";
    case ChannelRole::kTorque:
      return "torque";
    case ChannelRole::kGiven:
      return "given";
    case ChannelRole::kExtent:
      return "extent";
    case ChannelRole::kDeflection:
      return "deflection";
    case ChannelRole::kRate:
      return "rate";
    case ChannelRole::kContact:
      return "contact";
    case ChannelRole::kRoadHeight:
      return "road-height";
    case ChannelRole::kPressure:
      return "pressure";
    case ChannelRole::kMass:
      return "mass";
    case ChannelRole::kMassFlow:
      return "mass-flow";
  }
  return "";
}

}  // namespace sprung::dynamics

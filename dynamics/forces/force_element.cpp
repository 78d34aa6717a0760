#include "dynamics/forces/force_element.h"

#include <algorithm>

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

std::vector<int> ForceElement::turned_markers() const {
  return find_channel(ChannelRole::kTorque) ? markers() : std::vector<int>();
}

std::optional<std::size_t> ForceElement::find_channel(ChannelRole role) const {
  const std::span<const Channel> all = channels();
  const auto found =
      std::find_if(all.begin(), all.end(), [role](const Channel& channel) { return channel.role == role; });
  if (found == all.end()) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}

}  // namespace sprung::dynamics

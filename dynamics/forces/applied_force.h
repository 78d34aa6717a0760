#pragma once

#include "dynamics/forces/force_element.h"
#include "dynamics/functions/time_function.h"

namespace sprung::dynamics {

/// Force and torque on one marker as functions of time, in the axes of the world or of the marker (forces,
/// eq. 4). Their work is energy put in.
class AppliedForce final : public ForceElement {
 public:
  enum class Axes {
    kWorld,
    kFollowing,  ///< they turn with the marker, on a flexible body with the rotation of its node
  };
  struct Parameters {
    int marker = 0;
    Axes axes = Axes::kWorld;
    TimeFunction force_x, force_y;  ///< [N]
    TimeFunction torque;            ///< counter-clockwise [N·m]
  };
  AppliedForce(std::string element_name, Parameters parameters)
      : ForceElement(std::move(element_name)), parameters_(std::move(parameters)) {}

  std::string_view kind() const override { return "applied"; }
  std::vector<int> markers() const override { return {parameters_.marker}; }
  std::vector<int> turned_markers() const override;
  ElementDescription describe() const override;
  Power add_wrenches(const Instant& instant, std::span<const int> branches,
                     std::span<Wrench> wrenches) const override;
  std::vector<const TimeFunction*> time_functions() const override;

  std::span<const Channel> channels() const override;
  void calc_channels(const Instant& instant, std::span<const int> branches,
                     std::span<double> values) const override;

 private:
  Wrench calc_wrench(const Instant& instant) const;
  Parameters parameters_;
};

}  // namespace sprung::dynamics

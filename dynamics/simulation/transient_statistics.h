#pragma once

#include "dynamics/adaptivity/missing_acceleration.h"
#include "dynamics/adaptivity/neglect_record.h"
#include "dynamics/integration/system_stepper.h"

namespace sprung::dynamics {

struct TransientStatistics {
  SystemStepper::Statistics stepper;
  long output_evaluations = 0;  ///< of the equations, for the outputs
  long switches = 0;
  long mode_changes = 0;
  double mean_active_modes = 0.0;            ///< over time
  WorstNeglect worst_neglect;                ///< where adaptivity was asked for
  MissingAcceleration missing_acceleration;  ///< where modes were left out
  bool completed = false;                    ///< false: stopped by on_step
};

}  // namespace sprung::dynamics

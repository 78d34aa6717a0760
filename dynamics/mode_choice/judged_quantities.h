#pragma once

namespace sprung::dynamics {

/// The kinds of quantities that count where modes are left out, `[modes] judge` of a vehicle file.
struct JudgedQuantities {
  bool points = true;      ///< motion of the points asked for
  bool moments = true;     ///< bending moments of flexible bodies
  bool forces = false;     ///< of force elements, with torques
  bool reactions = false;  ///< of joints, with torques
};

}  // namespace sprung::dynamics

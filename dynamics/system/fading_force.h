#pragma once

namespace sprung::dynamics {

/// A force on a modal coordinate that fades smoothly to zero: F (1 + cos πs)/2 with s = (t − start)/duration
/// from 0 to 1, F before and zero after. It releases what held a mode that joins a run
/// (adaptivity, "Joining").
struct FadingForce {
  int coordinate = 0;     ///< of the model, a modal one
  double force = 0.0;     ///< F [N/√kg]
  double start = 0.0;     ///< [s]
  double duration = 0.0;  ///< > 0 [s]

  bool has_ended(double time) const { return time >= start + duration; }
  double value(double time) const;
};

}  // namespace sprung::dynamics

#pragma once

namespace sprung::dynamics {

/// How a force goes over to another of its formulas at the zero of a switch function.
enum class Passage {
  kJump,        ///< with a jump, or so that more than the force changes
  kBend,        ///< without a jump: force and power bend
  kBendAtRest,  ///< without a jump, and what is neither stored nor given back goes with the square of the
                ///< distance
};

}  // namespace sprung::dynamics

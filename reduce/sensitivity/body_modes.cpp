#include "reduce/sensitivity/body_modes.h"

#include <algorithm>
#include <numbers>

#include "reduce/modes/held_node.h"
#include "reduce/reduction/mechanism.h"

namespace sprung::reduce {

Eigen::VectorXd BodyModes::calc_hz() const {
  return omega_squared.cwiseSqrt() / (2.0 * std::numbers::pi);
}

BodyModes calc_body_modes(const Design& design, const BodyMatrices& matrices, bool is_free, int num_modes) {
  const ModalProblem problem = is_free ? matrices.free : matrices.make_held();
  const ClampedModes modes =
      calc_clamped_modes(problem, std::min(num_modes, static_cast<int>(problem.num_modes())));
  const Eigen::MatrixXd shapes = insert_node(modes.pairs.vectors, design.reference_node);
  check_rounding(design, problem.stiffness, modes.pairs);
  return {.omega_squared = modes.pairs.omega_squared,
          .shapes = is_free ? remove_momentum(matrices.rigid, shapes) : shapes,
          .cluster = modes.cluster};
}

}  // namespace sprung::reduce

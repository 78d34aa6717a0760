#pragma once

#include <string>

#include "reduce/reduction/body_basis.h"

namespace sprung::reduce {

/// Above this, single loads are no more held by the reference node. Loads in equilibrium lose far less.
inline constexpr double kMaxHeldRounding = 1e-2;

/// What rounding does to the frame held at its reference node while the whole body pulls at that node: of the
/// body's inertia at unit accelerations along x, y and in rotation the one with the largest relative error of
/// its work,
///
///     K u = M R,   error = 4 ε √(Σᵢⱼ (uᵢ Kᵢⱼ uⱼ)²) / uᵀK u                               (reduce, eq. 28)
///
/// Where the reference node hangs on something soft, u is nearly rigid, and the stiffness of the soft part is
/// lost in the entries of the stiff ones beside it.
struct HeldRounding {
  double error = 0.0;
  double bent_share = 1.0;  ///< of uᵀM u, what is no rigid motion

  /// Whether rounding spoils something, and a soft reference node is the cause.
  bool is_of_soft_reference() const;
};

/// Checked by tests/reduce/reduction/held_rounding_test.cpp
HeldRounding estimate_held_rounding(const BodyMatrices& matrices);

/// What to do about a reference node that is too soft: its name, and a named point that is stiffer, if there
/// is one.
std::string describe_soft_reference(const Design& design, const BodyMatrices& matrices);

}  // namespace sprung::reduce

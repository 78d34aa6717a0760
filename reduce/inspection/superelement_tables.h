#pragma once

#include <span>
#include <string>

#include "reduce/inspection/comparison.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// The kind of motion of each mode.
struct ModeKinds {
  Eigen::VectorXd
      axial_share;  ///< n, share of the strain energy; the rest is bending and shear; NaN without beams [-]
  /// 3×n, shares of m in x, of m in y, of J₀ about the reference, which take part in a motion of the
  /// reference node: what each vector adds to those before it (reduce, eq. 27) [-]
  Eigen::MatrixXd effective_mass;
};
ModeKinds calc_mode_kinds(const Superelement& superelement);

/// The elements whose section modulus the file has, so that their stresses are known.
Eigen::Index count_sized_elements(const Superelement& superelement);

// Tables for people; lines end in '\n'.
std::string format_summary(const Superelement& superelement);  ///< mass, inertia, points, where it comes from
std::string format_modes(const Superelement& superelement);
std::string format_checks(std::span<const CheckResult> checks);
std::string format_comparison(const Comparison& comparison);

}  // namespace sprung::reduce

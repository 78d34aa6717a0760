#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// Which coordinates are integrated (independent) and which follow from the constraints (dependent).
struct Partition {
  std::vector<int> independent;  ///< ascending, num_freedoms
  std::vector<int> dependent;    ///< ascending, num_constraints
  /// Of the pivots of φ_q, of the largest: it vanishes where constraints become dependent.
  double smallest_pivot = 1.0;
};

/// Chooses the partition by pivoting φ_q with its columns scaled by 1/√M_ii, so that light bodies follow
/// heavy ones and the largest pivots are taken (system, eq. 3).
/// @param terms  positions, Jacobian and mass up to date; φ_q of full row rank
/// Source: [Wehage & Haug 1982]
Partition choose_partition(const SystemTerms& terms);

/// Size that the smallest pivot of φ_q has where a mechanism is not near a change point: the largest of those
/// at a few positions at which all bodies are turned at will, and the joints are not closed. It does not
/// depend on the angles of the bodies.
/// @param q  nq   @return share of the largest pivot
double calc_usual_pivot(const Model& model, double time, const Eigen::VectorXd& q);

/// Finds constraints that depend on each other linearly: rows of φ_q whose scaled pivots vanish. The assembly
/// uses it for constraints that follow from others and for joints that cannot be satisfied together.
/// @return indices of constraints that take part in a linear dependence, empty where φ_q has full row rank
std::vector<int> find_dependent_constraints(const SystemTerms& terms);

}  // namespace sprung::dynamics

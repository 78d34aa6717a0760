#pragma once

#include <optional>

#include "fem/beam_model.h"
#include "fem/mass_moments.h"
#include "reduce/modes/stiffness_factor.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Largest number of values that the responses of a body may have; those of one value more are left out. As
/// many take 32 MB in the file.
inline constexpr Eigen::Index kMostResponseValues = 4'000'000;

/// The response of the frame held at its reference node to unit loads at its points and to its inertia, for
/// each of the loads (reduce, eqs. 23, 24).
struct StaticResponse {
  UnitLoads resultants;   ///< at the ends of the elements, exact there; rows as Superelement::resultants, 6E
  UnitLoads deflections;  ///< x, y and rotation of each of the superelement's points, 3p
};

/// @param reference_node  0-based; the body frame's origin
/// A body from matrices has no elements, hence no resultants, and its deflections in any number.
///
/// @param factor   of K without the reference node's freedoms
/// @param mass     M of all freedoms, 3N×3N
/// @param moments  about the reference node
/// @param shapes   3N×n
/// @return none for a body whose responses would have more values than kMostResponseValues
/// Checked by tests/reduce/reduction/static_response_test.cpp
std::optional<StaticResponse> calc_static_response(const fem::BeamModel& model, int reference_node,
                                                   const StiffnessFactor& factor,
                                                   const Eigen::SparseMatrix<double>& mass,
                                                   const fem::MassMoments& moments,
                                                   const Eigen::MatrixXd& shapes);

}  // namespace sprung::reduce

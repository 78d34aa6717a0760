#pragma once

#include <vector>

#include "reduce/modes/clusters.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Modes of an old and a new body that belong together. Either range may be empty: no counterpart.
struct ModeMatch {
  ModeRange old_modes, new_modes;  ///< one cluster each
  double old_hz = 0.0, new_hz = 0.0;
  /// Modal assurance criterion, 0 … 1: cos² of the largest principal angle between the two clusters'
  /// displacement spaces, of the smaller one's dimension; for two single modes (φᵀψ)²/(φᵀφ ψᵀψ). NaN where
  /// not comparable.
  double mac = 0.0;
};

/// Of the nodes of each body, that must lie on the other one for a MAC.
inline constexpr double kLeastShare = 0.5;

struct Comparison {
  int num_points = 0;                             ///< places where both bodies' displacements are known
  double share_of_old = 0.0, share_of_new = 0.0;  ///< of each body's nodes, that lie at these places
  bool comparable = true;                         ///< both are at least kLeastShare, and the next holds
  bool are_alike = true;           ///< both have free modes, or both have modes of the held body
  std::vector<ModeMatch> matches;  ///< in the order of the old modes, then the new
  /// Vectors that are no modes of the body, such as residual ones, which are not compared.
  Eigen::Index num_other_old = 0, num_other_new = 0;
};

/// Pairs the free or clamped modes of two bodies, cluster by cluster, by their displacements at the places
/// that both have (nodes of one that lie on the other, interpolated there by the elements' cubic), weighted
/// with the length that a node stands for. Where too few places are common, or one has free
/// modes and the other clamped ones, the clusters are paired in order, without a MAC.
///
/// Source: [Allemang 2003]; [Björck & Golub 1973] for the angles — checked by
/// tests/reduce/inspection/comparison_test.cpp
Comparison compare_modes(const Superelement& old_body, const Superelement& new_body);

}  // namespace sprung::reduce

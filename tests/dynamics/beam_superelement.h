#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "reduce/superelement/superelement.h"

namespace sprung::test {

/// A planar frame of straight Euler–Bernoulli beams, for bodies whose every integral can be summed in a test.
struct BeamFrame {
  struct Node {
    Eigen::Vector2d position;  ///< body frame [m]; the reference node's is (0, 0)
    std::string name = {};     ///< empty: not named
  };
  struct Beam {
    int first = 0, last = 0;       ///< 0-based nodes
    double EA = 0.0;               ///< [N]
    double EI = 0.0;               ///< [N·m²]
    double mass_per_length = 0.0;  ///< [kg/m]
  };
  std::string name;
  std::vector<Node> nodes;
  std::vector<Beam> beams;
  int reference_node = 0;  ///< held in all modes
  double damping_ratio = 0.01;
};

/// A piece of the body's mass: with enough of them, sums over them are the integrals over the body exactly
/// (Gauss points of the beams' shape functions).
struct MassPoint {
  double dm = 0.0;         ///< [kg]
  Eigen::Vector2d r;       ///< undeformed, body frame [m]
  Eigen::Matrix2Xd shape;  ///< φ, 2×n [m per unit modal coordinate]
};

struct BeamSuperelement {
  reduce::Superelement superelement;
  std::vector<MassPoint> points;
};

/// The frame reduced to its lowest modes, by dense matrices: independent of stage one.
/// @param num_modes  1 to 3 (nodes − 1)
BeamSuperelement make_beam_superelement(const BeamFrame& frame, int num_modes);

/// A straight uniform beam along x, its frame at the reference node.
/// @param positions  ascending x of the nodes, 0 among them: the reference node
BeamFrame make_straight_beam(const std::string& name, const std::vector<double>& positions, double EA,
                             double EI, double mass_per_length);

/// A crooked, branching frame without any symmetry, held at one end, so that no invariant vanishes. Nodes
/// "tip", "elbow", "foot".
BeamFrame make_crooked_frame();

}  // namespace sprung::test

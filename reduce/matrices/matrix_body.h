#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <string>
#include <vector>

#include "reduce/matrices/matrix_system.h"

namespace sprung::reduce {

/// What resists rigid motion of a body that should be free: nothing but rounding, or springs to the ground.
struct Ground {
  double frequency_hz = 0.0;  ///< at which the rigid body would vibrate on it: the highest of three [Hz]
  double stiffness = 0.0;     ///< of that motion [N/m, N·m]
  int motion = 0;             ///< 0: along x, 1: along y, 2: rotation about the middle of the nodes
  Eigen::Index freedom = 0;   ///< where it is the most beyond rounding
  bool is_rounding = true;    ///< whether the digits of the files explain all of it
};

/// A body in the plane, given by matrices in place of beams. Freedoms 3n, 3n+1, 3n+2 are node n's x and y
/// displacement and rotation, as those of fem::assemble. After those of the N nodes stand those of A mirrored
/// pairs: the motion of one node of a pair across the plane, and its rotations about x and about y. Last
/// stand the Q modal freedoms of a body that was reduced elsewhere, and freedoms without meaning up to a
/// multiple of 3: the size is n = 3 (N + A + ⌈Q/3⌉).
struct MatrixBody {
  std::vector<std::int64_t> node_ids;           ///< N, ascending
  Eigen::Matrix2Xd node_positions;              ///< 2×N [m]
  Eigen::SparseMatrix<double> stiffness, mass;  ///< n×n [N/m, N, N·m; kg, kg·m, kg·m²]
  /// Whether the files have a freedom. A rotation that they do not have follows the nodes around it; a
  /// freedom across the plane that they do not have is held by a spring that nothing else touches, and so are
  /// those without meaning. None of these has mass.
  std::vector<bool> is_given;
  int num_pairs = 0;                    ///< A
  std::vector<std::int64_t> modal_ids;  ///< Q, the numbers of the modal freedoms in the file
  /// The body was reduced elsewhere: its nodes move with a part of its motions alone, rigid ones included.
  bool is_reduced = false;
  /// Forces that the digits of the files explain in rigid motion along x, along y, and about the middle of
  /// the nodes; n×3 [N, N·m per m, per rad]
  Eigen::MatrixXd rounding;
  Ground ground;                          ///< of the stiffness before release_from_ground
  std::string stiffness_path, mass_path;  ///< for messages
  std::vector<std::string> remarks;       ///< on what the user should know

  int num_nodes() const { return static_cast<int>(node_ids.size()); }
};

/// The motion of a structure in its plane of symmetry (reduce/matrices, eqs. 1–3): nodes on the plane move in
/// it, the two nodes of a mirrored pair move alike.
///
/// @throws support::InputError if a freedom's node is not in the table; a node off the plane has no mirrored
/// one, or
///         one with other freedoms; the matrices couple symmetric with antisymmetric motion; a node lacks a
///         displacement in the plane
/// Checked by tests/reduce/matrices/matrices_test.py
MatrixBody make_matrix_body(const MatrixSystem& system, const PlanarAxes& axes, const MatrixUnits& units);

/// "x of node 12", also of the freedoms of pairs.
std::string describe_freedom(const MatrixBody& body, Eigen::Index freedom);

}  // namespace sprung::reduce

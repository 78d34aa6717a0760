#pragma once

#include <memory>

#include "fem/assembly.h"
#include "fem/mass_moments.h"
#include "reduce/design/design.h"
#include "reduce/modes/clamped_modes.h"
#include "reduce/modes/free_body.h"
#include "reduce/modes/stiffness_factor.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// The matrices of a design's frame, held at the reference node and free. The stiffness is factored once for
/// all that needs it.
struct BodyMatrices {
  fem::AssembledMatrices full;              ///< 3N×3N; of a body from matrices 3(N+A)×3(N+A) (MatrixBody)
  std::unique_ptr<StiffnessFactor> factor;  ///< of free.stiffness
  ModalProblem free;                        ///< elastic motion of the free body (free_body.h)
  RigidMotions rigid;
  Eigen::Matrix2Xd node_positions;  ///< 2×N, from the reference node [m]

  /// The frame held at its reference node, which has the same stiffness, in matrices of its own.
  ModalProblem make_held() const;
  /// Its freedoms with mass.
  Eigen::Index count_held_modes() const { return (free.mass.diagonal().array() != 0.0).count(); }
};
/// Stiffness and mass of the free frame alone, as in BodyMatrices::full.
fem::AssembledMatrices make_full_matrices(const Design& design);
/// @throws support::NumericalError if the stiffness is not positive definite to rounding
BodyMatrices make_body_matrices(const Design& design);

/// The loads of the soft twin by motion of the body frame (BasisRequest::frame_loads). @return n×4
Eigen::MatrixXd make_frame_loads(const Design& design, const RigidMotions& rigid);

/// Displacements of all nodes, from vectors of the held frame. @param vectors  (3N−3)×n   @return 3N×n
Eigen::MatrixXd make_shapes(const Design& design, const Eigen::MatrixXd& vectors);

/// Integrals over the mass of a design's beams, or of the matrices in their place.
fem::MassMoments make_mass_moments(const Design& design, const Eigen::Vector2d& origin);

/// The vectors that a body is reduced to, in the canonical basis, and what was proved of them.
struct BodyBasis {
  Eigen::MatrixXd shapes;     ///< 3N×n, 3(N+A)×n; the reference node does not move
  Eigen::VectorXi cluster;    ///< n
  Eigen::MatrixXd stiffness;  ///< n×n, diagonal but for what a cluster's frequencies differ by
  std::vector<std::string> kind;
  Certificate certificate;
  std::vector<CheckResult> checks;  ///< those that need the finite element model
};

/// Makes the basis that a design asks for, with its certificate.
/// @throws support::InputError, support::NumericalError  as make_superelement
BodyBasis make_body_basis(const Design& design, const BodyMatrices& matrices,
                          const ClampedModeOptions& options);

/// The frequencies of a basis: members of a cluster have one, the root of the mean square. @return n [Hz]
Eigen::VectorXd calc_frequencies(const BodyBasis& basis);

}  // namespace sprung::reduce

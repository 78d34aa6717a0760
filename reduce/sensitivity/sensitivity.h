#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "reduce/design/design_parameters.h"

namespace sprung::reduce {

/// What of a body depends on its design. All in SI units.
struct BodyQuantities {
  Eigen::VectorXd free_hz;      ///< of the lowest modes of the free body
  Eigen::VectorXd clamped_hz;   ///< of the lowest modes of the body held at the reference node
  double mass = 0.0;            ///< [kg]
  double inertia = 0.0;         ///< about the centre of mass [kg·m²]
  Eigen::VectorXd flexibility;  ///< at rest, of each interface freedom (reduce/certificate) [m/N, rad/(N·m)]
  /// The bound of each interface freedom over the band, of its flexibility; empty of a basis that is not
  /// free.
  Eigen::VectorXd certificate;
};

/// A parameter and the derivatives of the quantities by it.
struct ParameterSensitivity {
  DesignParameter parameter;
  BodyQuantities derivative;  ///< each in its unit over the parameter's
};

/// Where steel moves a free frequency: shares of the elements in the energies of each mode.
struct ElementShares {
  Eigen::MatrixXd strain, kinetic;  ///< elements × modes; each mode's sum is 1, point masses excepted
};

struct DesignSensitivity {
  BodyQuantities value;
  std::vector<ParameterSensitivity> parameters;
  ElementShares shares;  ///< of the free modes
};

/// Derivatives of a body by the parameters of its design (reduce/sensitivity). Frequencies of a cluster have
/// those of its modes as they part: the eigenvalues of Φᵀ(dK − ω²dM)Φ, ascending.
///
/// @param num_modes  free and clamped modes, ≥ 1; the last one's cluster is taken whole
/// @throws support::NumericalError as make_superelement
/// Source: [Fox & Kapoor 1968], [Lancaster 1964] — checked by tests/reduce/sensitivity/sensitivity_test.cpp
DesignSensitivity calc_sensitivity(const Design& design, std::vector<DesignParameter> parameters,
                                   int num_modes);

}  // namespace sprung::reduce

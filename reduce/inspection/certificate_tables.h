#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// What a basis is made of: `36 modes from 6.1100 to 4102.2 Hz`, or `4 free modes from 9.5 to 85.8 Hz, 12
/// residual vectors`.
std::string format_basis(const Superelement& superelement);

/// What the certificate says, in a line: `interface flexibility within 0.9 % up to 60 Hz (proved, of this
/// mesh); worst: front_spring y at 60 Hz`. Empty without a certificate or interface.
std::string format_certificate_line(const Superelement& superelement);

/// The certificate as tables: the free frequencies, and each interface freedom. Empty without a certificate.
std::string format_certificate(const Superelement& superelement);

/// What the damping ratios of a clamped basis mean for the modes of the free body, which a modal test
/// measures. Empty for another basis.
std::string format_free_damping(const Superelement& superelement);

/// A mode of the free body, as a basis gives it.
struct FreeModes {
  Eigen::VectorXd frequency_hz;   ///< n
  Eigen::VectorXd damping_ratio;  ///< n
};
/// The modes of the free body in the space of a basis, and their damping by the file's damping matrix
/// (reduce/basis, eq. 7).
/// @return none where they are lost in rounding
/// Checked by tests/reduce/inspection/certificate_tables_test.cpp
std::optional<FreeModes> calc_free_modes(const Superelement& superelement);

}  // namespace sprung::reduce

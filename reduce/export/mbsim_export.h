#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes PREFIX.h5, the input file of MBSim's ExternalFlexibleFfrBody: integrals of positions and shapes by
/// component (reduce/export, eqs. 17–19), stiffness, damping, and shapes at the nodes.
/// @throws support::InputError if a node's number has more than 31 bits
ExportReport export_mbsim(const Superelement& superelement, const std::string& prefix);

}  // namespace sprung::reduce

#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes PREFIX.fem, the file that the `modal` joint of MBDyn reads: nodes, shapes, modal matrices, rigid
/// inertia, and points with masses, of which MBDyn makes the inertia invariants (reduce/export, eqs. 1–5).
/// @throws support::InputError if no masses have the body's integrals (find_mass_points)
ExportReport export_mbdyn(const Superelement& superelement, const std::string& prefix);

}  // namespace sprung::reduce

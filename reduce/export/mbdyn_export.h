#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes PREFIX.fem, the file that the `modal` joint of MBDyn reads: nodes, shapes, modal matrices, rigid
/// inertia, and the invariants 3, 4, 5, 8 and 9 of the consistent mass (reduce/export, eqs. 1–5).
ExportReport export_mbdyn(const Superelement& superelement, const std::string& prefix);

}  // namespace sprung::reduce

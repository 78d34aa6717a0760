#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes modal stiffness, mass and damping, mode shapes, the mass matrix of frame and modes (reduce, eq. 18)
/// and B as Matrix Market files, with tables of the rows: PREFIX_stiffness.mtx …
ExportReport export_matrix_market(const Superelement& superelement, const std::string& prefix);

}  // namespace sprung::reduce

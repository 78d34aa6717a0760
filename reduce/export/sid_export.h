#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes PREFIX.SID_FEM, the standard input data of flexible bodies [Wallrapp 1994]: Taylor series in the
/// modal coordinates of all body integrals and of the motion of the nodes, with the geometric stiffness
/// (reduce/export, eqs. 6–12).
/// @param by_mode  the columns of Gr and Ge stand in blocks of three for each mode, else in blocks of n for
/// each axis
ExportReport export_sid(const Superelement& superelement, const std::string& prefix, bool by_mode);

}  // namespace sprung::reduce

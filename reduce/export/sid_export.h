#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes PREFIX.SID_FEM, the standard input data of flexible bodies [Wallrapp 1994]: Taylor series in the modal
/// coordinates of all body integrals and of the motion of the nodes, with the geometric stiffness (reduce/export,
/// eqs. 6–12).
/// @param mode_last  entries of first order are m1(row, column, mode), else m1(row, mode, column)
ExportReport export_sid(const Superelement& superelement, const std::string& prefix, bool mode_last);

}  // namespace sprung::reduce

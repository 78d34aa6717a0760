#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes PREFIX.hdf5, which Exudyn's ObjectFFRFreducedOrderInterface reads: matrices of the modes, mode
/// shapes of the nodes' displacements, and the integrals of its floating frame (reduce/export, eqs. 13–16).
/// The numbers of its nodes are in PREFIX_nodes.csv, row by row from 0.
ExportReport export_exudyn(const Superelement& superelement, const std::string& prefix);

}  // namespace sprung::reduce

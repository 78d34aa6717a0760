#pragma once

#include "reduce/export/export.h"

namespace sprung::reduce {

/// Writes everything but texts of provenance as tables: PREFIX_nodes.csv, PREFIX_modes.csv, and
/// PREFIX_values.csv with one row for each value of each dataset (reduce/superelement/superelement.md).
ExportReport export_csv(const Superelement& superelement, const std::string& prefix);

// Tables of what rows and columns of the matrices are.
std::string format_node_table(const Superelement& superelement);  ///< node,x,y,point
std::string format_freedom_table(
    const Superelement& superelement);  ///< node,direction, in the order of the shapes
std::string format_mode_table(
    const Superelement& superelement);  ///< mode,kind,frequency_hz,damping_ratio,cluster

}  // namespace sprung::reduce

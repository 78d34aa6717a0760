#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reduce/design/design.h"

namespace sprung::reduce {

/// Writes stiffness and mass of a design's frame, not reduced, with all freedoms: PREFIX_stiffness.mtx,
/// PREFIX_mass.mtx (Matrix Market, SI units), PREFIX_freedoms.csv and PREFIX_nodes.csv, which `[matrices]` of
/// a design reads.
/// @param file  the design's, for messages
/// @return the files
/// @throws support::InputError if a file cannot be written, the design gives the body by matrices itself, or
/// has points that follow others. Checked by tests/reduce/matrices/matrices_test.py
std::vector<std::filesystem::path> write_frame_matrices(const Design& design,
                                                        const std::filesystem::path& file,
                                                        const std::string& prefix);

}  // namespace sprung::reduce

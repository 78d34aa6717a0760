#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reduce/matrices/matrix_body.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// A body that other programs' matrices give, and the files they were read from.
struct DesignMatrices {
  MatrixBody body;
  std::vector<std::string> input_names;  ///< as the design names them
  std::vector<std::string> input_hashes;
};

/// Reads `[matrices]` of a design (reduce/matrices, "In a design") and the files it names, and checks them.
///
/// @param folder  the design file's, which the names are relative to
/// @throws support::InputError at the place of the fault, in the design or in one of the files
/// Checked by tests/reduce/matrices/matrix_errors_test.py
DesignMatrices read_design_matrices(const support::TomlTable& root, const std::filesystem::path& folder);

}  // namespace sprung::reduce

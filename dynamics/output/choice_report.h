#pragma once

#include <string>

#include "dynamics/mode_choice/basis_choice.h"
#include "tools/support/hdf5/hdf5_file.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// The choice in a few lines: how many modes, their predicted share, and the remarks.
std::string summarise_choice(const BasisChoice& choice);
/// The summary, and a table of the modes with the shares of each one alone, the decision and its reason.
std::string format_choice(const BasisChoice& choice);
/// The choice as a JSON object, shares as numbers.
support::Json make_choice_json(const BasisChoice& choice);
/// Writes the choice with forcing and transfer functions into a group of a file (dynamics/output/results.md).
/// Checked by tests/verification/select_test.py
void write_choice(support::Hdf5Writer& file, const std::string& group, const BasisChoice& choice);

}  // namespace sprung::dynamics

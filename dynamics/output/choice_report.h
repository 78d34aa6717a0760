#pragma once

#include <string>

#include "dynamics/mode_choice/basis_choice.h"
#include "tools/support/hdf5/hdf5_file.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// The choice in a line or two: how many modes, what is neglected, what was not taken into account.
std::string summarise_choice(const BasisChoice& choice);
/// The modes chosen for a run, as a table for people: what each is worth by itself, kept or not, and why.
std::string format_choice(const BasisChoice& choice);
/// The same as a JSON object, shares as numbers.
support::Json make_choice_json(const BasisChoice& choice);
/// Writes it with forcing and transfer functions into a group of a file (dynamics/output/results.md).
void write_choice(support::Hdf5Writer& file, const std::string& group, const BasisChoice& choice);

}  // namespace sprung::dynamics

#pragma once

#include <filesystem>
#include <string>

#include "reduce/matrices/matrix_entries.h"

namespace sprung::reduce {

/// Whether a file is a substructure: its first keyword is *USER ELEMENT.
/// @throws support::InputError if it cannot be read
bool is_abaqus_substructure(const std::filesystem::path& path);

/// Reads a matrix of a body that was condensed to the freedoms of some nodes, as *SUBSTRUCTURE MATRIX OUTPUT
/// of Abaqus and CalculiX writes it: *USER ELEMENT with the nodes in a comment and their directions, then for
/// each *MATRIX, TYPE=… the lower triangle, row by row. A node whose number is not positive is a modal
/// freedom.
///
/// @param type      "STIFFNESS" or "MASS": the matrix wanted; others in the file are left out
/// @param freedoms  gets the freedoms of the file
/// @param given     whether `freedoms` are known from a table, in the order of the rows; then the file's own
///                  are only counted
/// @throws support::InputError at the place of the fault: no such matrix, another number of values than the
///         freedoms need, a freedom twice, several elements, an unsymmetric one
/// Source: [Abaqus 2016], "*USER ELEMENT", "*MATRIX"; CalculiX 2.20 — checked by
/// tests/reduce/matrices/reduced_bodies_test.py
MatrixEntries read_abaqus_substructure(const std::filesystem::path& path, const std::string& type,
                                       FreedomList& freedoms, bool given);

}  // namespace sprung::reduce

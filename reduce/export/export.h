#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// What an export has written, and what of the superelement the format cannot hold.
struct ExportReport {
  std::vector<std::filesystem::path> paths;
  std::vector<std::string> left_out;
};

/// The names of the programs and formats that superelements are written for (reduce/export, "Targets").
std::vector<std::string> list_export_targets();

/// Writes a superelement for a program.
/// @param target  one of list_export_targets()
/// @param prefix  of the files' names
/// @throws support::InputError if a file cannot be written
/// Checked by tests/reduce/export/export_test.py
ExportReport export_superelement(const Superelement& superelement, const std::string& target,
                                 const std::string& prefix);

}  // namespace sprung::reduce

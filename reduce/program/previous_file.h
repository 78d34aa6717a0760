#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// What stands where a superelement is to be written.
struct PreviousFile {
  bool exists = false;
  std::optional<Superelement> superelement;  ///< if it can be read and verifies
  bool foreign =
      false;  ///< whole, but another program's or of a newer version: not to be replaced without asking
  std::string reason;  ///< why it cannot be read
};

PreviousFile read_previous_file(const std::filesystem::path& path);

/// Why a file has to be made again, or nothing if it is up to date: the design and its mesh files are hashed
/// anew.
/// @param design_path  the design it is to be made from
/// @throws support::InputError if the design or a mesh file cannot be read
std::string find_reason_to_rebuild(const Superelement& superelement,
                                   const std::filesystem::path& design_path);

}  // namespace sprung::reduce

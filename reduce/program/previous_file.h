#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "reduce/design/design.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// The file that is already there under the name of a superelement to be written.
struct PreviousFile {
  bool exists = false;
  std::optional<Superelement> superelement;  ///< if it can be read
  /// Another program's file, or a superelement of a newer version: it is replaced only with --force.
  bool foreign = false;
  std::string reason;  ///< why it cannot be read
};

PreviousFile read_previous_file(const std::filesystem::path& path);

/// Why a file has to be made again, or nothing if it is up to date: the design and its mesh files are hashed
/// anew.
/// @param design  that it is to be made from
/// @throws support::InputError if the design or a mesh file cannot be read
std::string find_reason_to_rebuild(const Superelement& superelement, const DesignSource& design);

}  // namespace sprung::reduce

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/support/files/unfinished_file.h"

namespace sprung::support {

/// The file in which a target is written until it is complete, locked so that no other program writes it: it
/// is empty, or what a killed program has left, until its owner writes it. A signal that ends the program
/// removes it. Checked by tests/tools/support/temporary_file_test.cpp
class TemporaryFile {
 public:
  /// Makes the file.
  /// @throws InputError if the folder is missing, the target or the temporary file is not a regular file, or
  /// another program is writing it
  explicit TemporaryFile(std::filesystem::path target);
  ~TemporaryFile();  ///< removes the file, unless it was renamed or left
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& path() const { return path_; }

  /// Writes the file through to the disk and gives it another name in its folder.
  /// @return "" or the reason why it still has its name
  std::string try_rename_to(const std::filesystem::path& name);
  void rename_to_target();  ///< likewise; @throws InputError with the reason
  void leave();             ///< gives up the lock, and the file stays where it is

 private:
  bool is_in_place() const;  // nobody has removed or replaced it

  std::filesystem::path target_, path_;
  int descriptor_ = -1;  // holds the lock, as long as this is the owner
  std::optional<UnfinishedFile> unfinished_;
};

}  // namespace sprung::support

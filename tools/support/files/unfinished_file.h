#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

namespace sprung::support {

/// A file that is of no use until it is whole. If a signal ends the program before, remove_unfinished_files
/// removes it; otherwise it is left alone. The path has to remain right if it is relative.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

 private:
  std::optional<std::size_t> slot_;  ///< none: too many at the same time, or too long a path
};

/// Removes the files of all UnfinishedFile that exist. For a signal handler, after which the program ends.
/// Checked by tests/tools/support/program_test.cpp
void remove_unfinished_files() noexcept;

}  // namespace sprung::support

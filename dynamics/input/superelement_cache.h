#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

#include "reduce/superelement/superelement.h"

namespace sprung::dynamics {

/// Superelements by their files, for a process that reads the same ones many times: reading and checking that
/// of a truck's chassis costs as much as a second of its motion. A file that has changed is read again.
class SuperelementCache {
 public:
  /// @param age  that a file must have to be kept [ns]: within one tick of the file system's clock a file can
  ///             change and keep its times
  explicit SuperelementCache(std::int64_t age = 1'000'000'000) : age_(age) {}

  /// A superelement, read from its file as reduce::read_superelement() does unless it was before.
  /// @throws support::InputError if the file cannot be used
  /// Checked by tests/dynamics/input/superelement_cache_test.cpp
  reduce::Superelement read(const std::filesystem::path& path);
  long num_reads() const { return num_reads_; }  ///< of files, until now

 private:
  using FileId = std::pair<std::uint64_t, std::uint64_t>;  // device, inode
  struct Entry {
    std::uint64_t size = 0;
    std::int64_t modified = 0, changed = 0;  // times of the content and of the inode [ns]
    reduce::Superelement superelement;
  };
  std::int64_t age_;
  long num_reads_ = 0;
  std::map<FileId, Entry> entries_;
};

}  // namespace sprung::dynamics

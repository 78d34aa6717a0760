#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support::hdf5 {
class StoredDataset;
}

namespace sprung::support {

/// Reads an HDF5 file strictly. A missing dataset, an unexpected type or shape, NaN, infinity or a wrong
/// checksum throws InputError `path: error: dataset '…' …`. Declared sizes are compared with the size of the
/// file before memory is allocated. Strings of variable length are refused: this project's files have none,
/// and they have no checksum.
class Hdf5Reader {
 public:
  /// Whether datasets may be compressed by "shuffle" and "deflate". A few bytes may then stand for a thousand
  /// times as many, so only files with histories may have them.
  enum class Compression { kRefused, kAllowed };
  /// @throws InputError if the file is missing, empty, truncated, not HDF5, or was left open by its writer.
  explicit Hdf5Reader(std::filesystem::path path, Compression compression = Compression::kRefused);

  bool has(const std::string& object) const;
  std::vector<std::int64_t> shape(const std::string& dataset) const;

  // Values in row-major order. `shape` is the expected one; -1 accepts any number.
  std::vector<double> reals(const std::string& dataset, const std::vector<std::int64_t>& shape) const;
  std::vector<std::int64_t> integers(const std::string& dataset,
                                     const std::vector<std::int64_t>& shape) const;
  std::vector<std::string> strings(const std::string& dataset, const std::vector<std::int64_t>& shape) const;
  /// Likewise, into the memory that `place` gives for the shape that the dataset has. @return this shape
  std::vector<std::int64_t> read_reals(
      const std::string& dataset, const std::vector<std::int64_t>& shape,
      const std::function<std::span<double>(const std::vector<std::int64_t>&)>& place) const;
  /// Rows first to first + count − 1 of a dataset of any rank ≥ 1.
  std::vector<double> real_rows(const std::string& dataset, std::size_t first, std::size_t count) const;

  /// Attributes of a group or dataset; "/" for the file itself.
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::string string_attribute(const std::string& object, const std::string& name) const;
  std::int64_t integer_attribute(const std::string& object, const std::string& name) const;
  double real_attribute(const std::string& object, const std::string& name) const;

  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(std::string_view message) const;
  hdf5::StoredDataset open(const std::string& dataset) const;
  template <typename Function>
  auto attempt(Function&& function) const;  // HDF5's failures as InputError of this file

  std::filesystem::path path_;
  Compression compression_;
  std::uint64_t file_size_ = 0;
  Hdf5Handle file_;
};

}  // namespace sprung::support

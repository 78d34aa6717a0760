#pragma once

// Private to this room: datasets and attributes of a file that is not trusted, checked before they are read.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support::hdf5 {

/// A dataset that is stored plainly: chunked or contiguous, not compressed unless that is allowed, and in
/// this file.
class StoredDataset {
 public:
  /// @param file_size  [bytes]; a dataset that declares more than this is refused
  /// @throws Failure if it is missing, damaged, or declares more data than the file holds
  StoredDataset(std::int64_t file, const std::string& path, std::uint64_t file_size, bool may_be_compressed);

  const std::vector<std::size_t>& shape() const { return shape_; }
  /// @param expected  -1 accepts any  @throws Failure naming both shapes
  void expect_shape(std::span<const std::int64_t> expected) const;
  /// From here on only these rows are read, and shape() is theirs. @throws Failure if there are fewer
  void select_rows(std::size_t first, std::size_t count);

  // Row-major. @throws Failure on another type, a checksum that does not fit, NaN or infinity
  std::vector<double> read_doubles() const;
  void read_doubles(std::span<double> values) const;  ///< @param values  as many as the shape has
  std::vector<std::int64_t> read_integers() const;
  std::vector<std::string> read_strings() const;

 private:
  void check_storage(std::uint64_t file_size, bool may_be_compressed) const;
  void read(std::int64_t memory_type, void* values) const;

  std::string label_;  // "dataset '/modes/shape'"
  Hdf5Handle dataset_;
  Hdf5Handle type_;
  Hdf5Handle space_;                // of the file, with the rows selected
  std::vector<std::size_t> shape_;  // of what is read
  std::size_t count_ = 1;           // values
};

/// A single value attached to a group or dataset.
class StoredAttribute {
 public:
  StoredAttribute(std::int64_t file, const std::string& object, const std::string& name,
                  std::uint64_t file_size);

  // @throws Failure on another type
  std::int64_t read_integer() const;
  double read_real() const;  // and on NaN and infinity
  std::string read_string() const;

 private:
  std::string label_;
  Hdf5Handle attribute_;
  Hdf5Handle type_;
};

}  // namespace sprung::support::hdf5

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support {

/// A dataset of doubles whose rows grow, kept open and written by whole chunks. Used by Hdf5Writer alone.
/// Failures of HDF5 are thrown as hdf5::Failure.
class Hdf5GrowingDataset {
 public:
  /// @param parent   file or group identifier
  /// @param path     of the dataset; its group exists
  /// @param columns  0 for rank 1
  Hdf5GrowingDataset(std::int64_t parent, const std::string& path, std::size_t columns,
                     std::string_view unit);

  /// @throws std::invalid_argument if the values are not whole rows
  void append(std::span<const double> values);
  void write_pending();  ///< what has not come to a whole chunk yet; more may follow

 private:
  std::size_t row_size() const { return columns_ == 0 ? 1 : columns_; }
  void append_row(const double* values);
  void write_chunk();

  std::string path_;
  std::size_t columns_;
  std::size_t chunk_rows_;
  std::size_t rows_before_ = 0;  // the chunk's first row
  std::size_t filled_ = 0;       // values in it
  std::vector<double> chunk_;    // as it goes to the file, with room for the checksum
  Hdf5Handle dataset_;
};

}  // namespace sprung::support

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support {

class ChunkCompressor;

/// The rows that a dataset will have. Its chunks are made equal for them: the last one takes its whole size
/// in the file, however few rows it has.
struct ExpectedRows {
  static constexpr std::size_t kMostPerChunk = 1024;

  std::size_t number = kMostPerChunk;
  std::size_t most_per_chunk = kMostPerChunk;
};

/// A dataset of doubles or of texts to which rows are appended. It stays open and is written in whole chunks.
/// Only Hdf5Writer uses it. Failures of HDF5 are thrown as hdf5::Failure.
///
/// With a compressor the values are stored in single precision, and full chunks compressed. A chunk that is
/// not full yet is written as it is: it then has one size, and stays in its place in the file. Its compressed
/// form is kept until `write_replacements`, because it frees this place for others, while the file on the
/// disk still refers to it.
class Hdf5GrowingDataset {
 public:
  /// @param parent      identifier of its group, or of the file
  /// @param path        of the dataset, from the root
  /// @param columns     0 for rank 1
  /// @param compressor  null for doubles that are not compressed; otherwise it has to outlive this
  /// @param is_rounded  whether values are rounded before they are compressed
  Hdf5GrowingDataset(std::int64_t parent, const std::string& path, std::size_t columns, std::string_view unit,
                     ChunkCompressor* compressor, bool is_rounded, const ExpectedRows& rows);
  /// A dataset of texts, rank 1. @param text_size  the most bytes of a text: what goes beyond is cut off
  Hdf5GrowingDataset(std::int64_t parent, const std::string& path, std::size_t text_size);

  /// @throws std::invalid_argument if the values are not whole rows
  void append(std::span<const double> values);
  /// The place of the next row, for its values.
  std::span<double> next_row() { return {chunk_.data() + filled_, row_size_}; }
  /// Appends the row that has been put there. @return whether the chunk is full: `write_full` has to follow
  bool advance() {
    filled_ += row_size_;
    return filled_ == chunk_.size() - 1;
  }
  void write_full();
  void append_text(std::string_view text);  ///< to a dataset of texts, UTF-8
  void write_pending();       ///< writes the rows of a chunk that is not full yet; more rows may follow
  void write_replacements();  ///< compressed chunks in place of what write_pending has written
  void write_last();          ///< compresses the rows of a chunk that is not full, after which none follow

 private:
  void write_chunk();
  void write_single(bool is_final);
  void put_chunk(std::size_t first_row, std::size_t rows, std::span<const std::uint8_t> bytes,
                 std::uint32_t filters_left_out);

  std::string path_;
  std::size_t columns_;   // of the dataset, 0 for rank 1
  std::size_t row_size_;  // doubles, or as much space for a text
  std::size_t chunk_rows_;
  std::size_t rows_before_ = 0;  // in earlier chunks
  std::size_t filled_ = 0;       // values in the present chunk
  std::vector<double> chunk_;    // as it is written to the file, with space for the checksum
  ChunkCompressor* compressor_ = nullptr;
  bool is_rounded_ = false;
  bool pending_is_written_ = false;        // the present chunk is in the file, not compressed
  std::vector<std::uint8_t> replacement_;  // of the chunk at replaced_row_; empty if there is none
  std::size_t replaced_row_ = 0;
  Hdf5Handle dataset_;
};

}  // namespace sprung::support

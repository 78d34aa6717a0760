#include "tools/support/hdf5/hdf5_growing_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "tools/support/hdf5/chunk_compressor.h"
#include "tools/support/hdf5/fletcher32.h"
#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support {

namespace {

constexpr std::size_t kTextChunkRows = 64;
constexpr std::size_t kMostChunkValues = (std::size_t{1} << 20U) / sizeof(double);

// Two rows at least, and no odd number: the checksum of numbers of single precision needs an even number of
// them.
std::size_t find_chunk_rows(const ExpectedRows& rows, std::size_t row_size) {
  const std::size_t most = std::max<std::size_t>(
      std::min({rows.most_per_chunk, kMostChunkValues / row_size, ExpectedRows::kMostPerChunk}), 2);
  const std::size_t chunks = std::max<std::size_t>((rows.number + most - 1) / most, 1);
  const std::size_t even = (rows.number + 2 * chunks - 1) / (2 * chunks) * 2;
  return std::max<std::size_t>(even, 2);
}

// One or two dimensions, as HDF5 takes them: the rank is that of the dataset.
std::span<const hsize_t> shape_of(const std::array<hsize_t, 2>& rows_and_columns, std::size_t columns) {
  return std::span<const hsize_t>(rows_and_columns).first(columns == 0 ? 1 : 2);
}

// The nearest number with 17 binary digits, of the 24 of single precision: a relative error of 2⁻¹⁷. The
// other digits of a history are noise to a compression. Overflow gives infinity.
float round_to_17_digits(float value) {
  constexpr std::uint32_t kLeftOut = (1U << 7U) - 1U, kHalfUnit = 1U << 6U;
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(value) + kHalfUnit) & ~kLeftOut);
}

std::string describe_overflow(const std::string& path, double value) {
  return fmt::format("dataset '{}' cannot hold {:.3g}: single precision ends at {:.1e}", path, value,
                     std::numeric_limits<float>::max());
}

}  // namespace

Hdf5GrowingDataset::Hdf5GrowingDataset(std::int64_t parent, const std::string& path, std::size_t columns,
                                       std::string_view unit, ChunkCompressor* compressor, bool is_rounded,
                                       const ExpectedRows& rows)
    : path_(path),
      columns_(columns),
      row_size_(std::max<std::size_t>(columns, 1)),
      chunk_rows_(find_chunk_rows(rows, row_size_)),
      compressor_(compressor),
      is_rounded_(is_rounded) {
  const std::array<hsize_t, 2> shape{0, columns};
  const std::array<hsize_t, 2> chunk{chunk_rows_, columns};
  dataset_ = hdf5::make_dataset(parent, path, compressor ? H5T_IEEE_F32LE : H5T_IEEE_F64LE,
                                shape_of(shape, columns), shape_of(chunk, columns),
                                compressor ? hdf5::Storage::kCompressed : hdf5::Storage::kGrowing);
  hdf5::write_string_attribute(dataset_.get(), "unit", unit);
  chunk_.assign(chunk_rows_ * row_size_ + 1, 0.0);
}

Hdf5GrowingDataset::Hdf5GrowingDataset(std::int64_t parent, const std::string& path, std::size_t text_size)
    : path_(path), columns_(0), row_size_(text_size / sizeof(double) + 1), chunk_rows_(kTextChunkRows) {
  const Hdf5Handle type = hdf5::make_string_type(row_size_ * sizeof(double));
  const std::array<hsize_t, 2> shape{0, 0}, chunk{chunk_rows_, 0};
  dataset_ = hdf5::make_dataset(parent, path, type.get(), shape_of(shape, 0), shape_of(chunk, 0),
                                hdf5::Storage::kGrowing);
  chunk_.assign(chunk_rows_ * row_size_ + 1, 0.0);
}

void Hdf5GrowingDataset::append(std::span<const double> values) {
  if (values.size() % row_size_ != 0) {
    throw std::invalid_argument(
        fmt::format("Hdf5Writer::append: {} values are not whole rows of '{}' ({} columns)", values.size(),
                    path_, row_size_));
  }
  for (; !values.empty(); values = values.subspan(row_size_)) {
    std::copy_n(values.begin(), row_size_, next_row().begin());
    if (advance()) write_full();
  }
}

void Hdf5GrowingDataset::append_text(std::string_view text) {
  const std::size_t space = row_size_ * sizeof(double);
  std::size_t size = std::min(text.size(), space);
  const auto continues_a_character = [&](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (size > 0 && continues_a_character(size)) --size;
  const std::span<double> row = next_row();
  std::fill(row.begin(), row.end(), 0.0);
  std::memcpy(row.data(), text.data(), size);
  if (advance()) write_full();
}

void Hdf5GrowingDataset::write_full() {
  if (compressor_) {
    write_single(true);
  } else {
    write_chunk();
  }
  rows_before_ += chunk_rows_;
  filled_ = 0;
  pending_is_written_ = false;
}

void Hdf5GrowingDataset::write_pending() {
  if (filled_ == 0) return;
  std::fill(chunk_.begin() + static_cast<std::ptrdiff_t>(filled_), chunk_.end(),
            0.0);  // rows of the chunk before
  if (compressor_) {
    write_single(false);
  } else {
    write_chunk();
  }
}

void Hdf5GrowingDataset::write_last() {
  if (filled_ == 0) return;
  if (!compressor_) return write_pending();
  std::fill(chunk_.begin() + static_cast<std::ptrdiff_t>(filled_), chunk_.end(), 0.0);
  write_single(true);
  rows_before_ += filled_ / row_size_;
  filled_ = 0;
}

void Hdf5GrowingDataset::write_replacements() {
  if (replacement_.empty()) return;
  put_chunk(replaced_row_, rows_before_ + filled_ / row_size_, replacement_, 0);
  replacement_.clear();
}

// Writes the chunk with its checksum directly: the library would copy it twice, and its own checksum is slow.
void Hdf5GrowingDataset::write_chunk() {
  static_assert(std::endian::native == std::endian::little, "chunks are written as they are in memory");
  const std::size_t size = chunk_rows_ * row_size_;
  const std::uint32_t checksum = calc_fletcher32(std::as_bytes(std::span(chunk_).first(size)));
  std::memcpy(chunk_.data() + size, &checksum, sizeof checksum);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(chunk_.data()),
                        size * sizeof(double) + sizeof checksum);
  put_chunk(rows_before_, rows_before_ + filled_ / row_size_, bytes, 0);
}

// Writes the chunk in single precision, compressed if it is final.
void Hdf5GrowingDataset::write_single(bool is_final) {
  constexpr std::uint32_t kShuffleAndDeflate = 0b110;  // bits of the filters in their order
  const std::size_t rows = rows_before_ + filled_ / row_size_;
  std::vector<float> values(chunk_rows_ * row_size_);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(chunk_[i]);
    if (is_rounded_) values[i] = round_to_17_digits(values[i]);
    if (std::isinf(values[i]) && std::isfinite(chunk_[i]))
      throw hdf5::Failure(describe_overflow(path_, chunk_[i]));
  }
  const std::vector<std::uint8_t> bytes = ChunkCompressor::append_checksum(values);
  if (!is_final) {
    put_chunk(rows_before_, rows, bytes, kShuffleAndDeflate);
    pending_is_written_ = true;
  } else if (pending_is_written_) {
    replacement_ = compressor_->compress(bytes);
    replaced_row_ = rows_before_;
  } else {
    put_chunk(rows_before_, rows, compressor_->compress(bytes), 0);
  }
}

// @param rows  of the dataset from then on
void Hdf5GrowingDataset::put_chunk(std::size_t first_row, std::size_t rows,
                                   std::span<const std::uint8_t> bytes, std::uint32_t filters_left_out) {
  const std::string what = fmt::format("dataset '{}' cannot be written", path_);
  const std::array<hsize_t, 2> shape{rows, columns_};
  const std::array<hsize_t, 2> start{first_row, 0};
  hdf5::check(H5Dset_extent(dataset_.get(), shape.data()), what);
  hdf5::check(
      H5Dwrite_chunk(dataset_.get(), H5P_DEFAULT, filters_left_out, start.data(), bytes.size(), bytes.data()),
      what);
}

}  // namespace sprung::support

#include "tools/support/hdf5/hdf5_growing_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "tools/support/hdf5/fletcher32.h"
#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support {

namespace {

constexpr std::size_t kMostChunkRows = 1024;
constexpr std::size_t kTextChunkRows = 64;
constexpr std::size_t kMostChunkValues = (std::size_t{1} << 20U) / sizeof(double);

// One or two dimensions, as HDF5 takes them: the rank is that of the dataset.
std::span<const hsize_t> shape_of(const std::array<hsize_t, 2>& rows_and_columns, std::size_t columns) {
  return std::span<const hsize_t>(rows_and_columns).first(columns == 0 ? 1 : 2);
}

}  // namespace

Hdf5GrowingDataset::Hdf5GrowingDataset(std::int64_t parent, const std::string& path, std::size_t columns,
                                       std::string_view unit)
    : path_(path),
      columns_(columns),
      row_size_(std::max<std::size_t>(columns, 1)),
      chunk_rows_(std::clamp<std::size_t>(kMostChunkValues / row_size_, 1, kMostChunkRows)) {
  const std::array<hsize_t, 2> shape{0, columns};
  const std::array<hsize_t, 2> chunk{chunk_rows_, columns};
  dataset_ = hdf5::make_dataset(parent, path, H5T_IEEE_F64LE, shape_of(shape, columns),
                                shape_of(chunk, columns), true);
  hdf5::write_string_attribute(dataset_.get(), "unit", unit);
  chunk_.assign(chunk_rows_ * row_size_ + 1, 0.0);
}

Hdf5GrowingDataset::Hdf5GrowingDataset(std::int64_t parent, const std::string& path, std::size_t text_size)
    : path_(path), columns_(0), row_size_(text_size / sizeof(double) + 1), chunk_rows_(kTextChunkRows) {
  const Hdf5Handle type = hdf5::make_string_type(row_size_ * sizeof(double));
  const std::array<hsize_t, 2> shape{0, 0}, chunk{chunk_rows_, 0};
  dataset_ = hdf5::make_dataset(parent, path, type.get(), shape_of(shape, 0), shape_of(chunk, 0), true);
  chunk_.assign(chunk_rows_ * row_size_ + 1, 0.0);
}

void Hdf5GrowingDataset::append(std::span<const double> values) {
  if (values.size() == row_size_) {  // by far the most frequent case
    append_row(values.data());
    return;
  }
  if (values.size() % row_size_ != 0) {
    throw std::invalid_argument(
        fmt::format("Hdf5Writer::append: {} values are not whole rows of '{}' ({} columns)", values.size(),
                    path_, row_size_));
  }
  for (; !values.empty(); values = values.subspan(row_size_)) append_row(values.data());
}

void Hdf5GrowingDataset::append_text(std::string_view text) {
  const std::size_t space = row_size_ * sizeof(double);
  std::size_t size = std::min(text.size(), space);
  const auto continues_a_character = [&](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (size > 0 && continues_a_character(size)) --size;
  double* row = chunk_.data() + filled_;
  std::fill(row, row + row_size_, 0.0);
  std::memcpy(row, text.data(), size);
  finish_row();
}

void Hdf5GrowingDataset::append_row(const double* values) {
  const std::size_t n = row_size_;
  double* row = chunk_.data() + filled_;
  for (std::size_t i = 0; i < n; ++i)
    row[i] = values[i];  // mostly few, for which a loop is faster than a call
  finish_row();
}

void Hdf5GrowingDataset::finish_row() {
  filled_ += row_size_;
  if (filled_ < chunk_.size() - 1) return;
  write_chunk();
  rows_before_ += chunk_rows_;
  filled_ = 0;
}

void Hdf5GrowingDataset::write_pending() {
  if (filled_ == 0) return;
  std::fill(chunk_.begin() + static_cast<std::ptrdiff_t>(filled_), chunk_.end(),
            0.0);  // rows of the chunk before
  write_chunk();
}

// Writes the chunk with its checksum directly: the library would copy it twice, and its own checksum is slow.
void Hdf5GrowingDataset::write_chunk() {
  static_assert(std::endian::native == std::endian::little, "chunks are written as they are in memory");
  const std::string what = fmt::format("dataset '{}' cannot be written", path_);
  const std::size_t size = chunk_rows_ * row_size_;
  const std::array<hsize_t, 2> shape{rows_before_ + filled_ / row_size_, columns_};
  const std::array<hsize_t, 2> start{rows_before_, 0};
  const std::uint32_t checksum = calc_fletcher32(std::span(chunk_).first(size));
  std::memcpy(chunk_.data() + size, &checksum, sizeof checksum);
  hdf5::check(H5Dset_extent(dataset_.get(), shape.data()), what);
  hdf5::check(H5Dwrite_chunk(dataset_.get(), H5P_DEFAULT, 0, start.data(),
                             size * sizeof(double) + sizeof checksum, chunk_.data()),
              what);
}

}  // namespace sprung::support

#include "tools/support/hdf5_growing_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "tools/support/hdf5_library.h"

namespace sprung::support {

namespace {

constexpr std::size_t kMostChunkRows = 1024;
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
      chunk_rows_(std::clamp<std::size_t>(kMostChunkValues / row_size(), 1, kMostChunkRows)) {
  const std::array<hsize_t, 2> shape{0, columns};
  const std::array<hsize_t, 2> chunk{chunk_rows_, columns};
  dataset_ = hdf5::make_dataset(parent, path, H5T_IEEE_F64LE, shape_of(shape, columns),
                                shape_of(chunk, columns), true);
  hdf5::write_string_attribute(dataset_.get(), "unit", unit);
  pending_.reserve(chunk_rows_ * row_size());
}

void Hdf5GrowingDataset::append(std::span<const double> values) {
  if (values.size() % row_size() != 0) {
    throw std::invalid_argument(
        fmt::format("Hdf5Writer::append: {} values are not whole rows of '{}' ({} columns)", values.size(),
                    path_, row_size()));
  }
  const std::size_t chunk_size = chunk_rows_ * row_size();
  while (!values.empty()) {
    const std::size_t taken = std::min(values.size(), chunk_size - pending_.size());
    pending_.insert(pending_.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(taken));
    values = values.subspan(taken);
    if (pending_.size() == chunk_size) write_pending();
  }
}

void Hdf5GrowingDataset::write_pending() {
  if (pending_.empty()) return;
  write_rows(pending_.data(), pending_.size() / row_size());
  pending_.clear();
}

void Hdf5GrowingDataset::write_rows(const double* values, std::size_t rows) {
  const std::string what = fmt::format("dataset '{}' cannot be written", path_);
  const int rank = columns_ == 0 ? 1 : 2;
  const std::array<hsize_t, 2> shape{num_written_ + rows, columns_};
  const std::array<hsize_t, 2> start{num_written_, 0};
  const std::array<hsize_t, 2> count{rows, columns_};
  hdf5::check(H5Dset_extent(dataset_.get(), shape.data()), what);
  const Hdf5Handle target = hdf5::own(H5Dget_space(dataset_.get()), H5Sclose, what);
  hdf5::check(H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
              what);
  const Hdf5Handle source = hdf5::own(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, what);
  hdf5::check(H5Dwrite(dataset_.get(), H5T_NATIVE_DOUBLE, source.get(), target.get(), H5P_DEFAULT, values),
              what);
  num_written_ += rows;
}

}  // namespace sprung::support

#include "tools/support/hdf5/hdf5_writer.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "tools/support/errors/input_error.h"
#include "tools/support/files/output_target.h"
#include "tools/support/hdf5/chunk_compressor.h"
#include "tools/support/hdf5/created_file.h"
#include "tools/support/hdf5/flushed_file.h"
#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support {

namespace fs = std::filesystem;

// The content of one dataset.
struct Hdf5Writer::Array {
  std::int64_t file_type;
  std::int64_t memory_type;
  std::size_t element_size;  // [bytes]
  const void* data;
  std::size_t count;  // values at `data`, which the shape must ask for
  std::vector<hsize_t> shape;
  std::optional<std::string_view> unit = {};

  static Array of(std::span<const double> values, std::vector<hsize_t> shape, std::string_view unit) {
    return {.file_type = H5T_IEEE_F64LE,
            .memory_type = H5T_NATIVE_DOUBLE,
            .element_size = sizeof(double),
            .data = values.data(),
            .count = values.size(),
            .shape = std::move(shape),
            .unit = unit};
  }
  static Array of(std::span<const std::int64_t> values, std::vector<hsize_t> shape) {
    return {.file_type = H5T_STD_I64LE,
            .memory_type = H5T_NATIVE_INT64,
            .element_size = sizeof(std::int64_t),
            .data = values.data(),
            .count = values.size(),
            .shape = std::move(shape)};
  }
};

namespace {

// The path in one form, however it was written.
std::string from_root(const std::string& path) {
  return path.starts_with('/') ? path.substr(1) : path;
}

void reject_nul(std::string_view text, const std::string& place) {
  if (text.find('\0') != std::string_view::npos) {
    throw std::invalid_argument(fmt::format("Hdf5Writer: a string of '{}' contains NUL", place));
  }
}

}  // namespace

Hdf5Writer::Hdf5Writer(fs::path target, fs::path partial)
    : temporary_(std::move(target)), partial_(std::move(partial)) {
  const fs::path& final_name = temporary_.target();
  if (!partial_.empty()) {
    if (folder_of(partial_).lexically_normal() != folder_of(final_name).lexically_normal()) {
      throw std::invalid_argument(fmt::format("Hdf5Writer: partial file '{}' is not in the folder of '{}'",
                                              partial_.string(), final_name.string()));
    }
    check_replaceable(final_name, partial_);
    remove_left_over(partial_);
  }
  hdf5::initialize();
  attempt([this] { file_ = hdf5::create_file(temporary_.path()); });
}

Hdf5Writer::~Hdf5Writer() {
  if (!finished_) abandon();
}

template <typename Function>
void Hdf5Writer::attempt(Function&& function) {
  try {
    function();
  } catch (const hdf5::Failure& failure) {
    throw InputError({.path = temporary_.target().string()}, failure.what());
  }
}

bool Hdf5Writer::has(const std::string& path) const {
  return objects_.contains(from_root(path));
}

// An object that is there. It stays open until another one is asked for: most attributes and datasets follow
// others of the same group, and the way from the root to it costs more than they.
std::int64_t Hdf5Writer::open(const std::string& path) {
  if (path.empty() || path == "/") return file_.get();
  if (path != open_path_ || open_object_.get() < 0) {
    open_object_ = hdf5::own(H5Oopen(file_.get(), path.c_str(), H5P_DEFAULT), H5Oclose,
                             fmt::format("'{}' cannot be opened", path));
    open_path_ = path;
  }
  return open_object_.get();
}

// Makes each group of the path that is missing.
void Hdf5Writer::make_groups(const std::string& path) {
  if (path.empty() || path == "/" || has(path)) return;
  const std::string parent = hdf5::parent_path(path);
  make_groups(parent);
  const std::string what = fmt::format("group '{}' cannot be made", path);
  const Hdf5Handle properties = hdf5::make_properties(H5P_GROUP_CREATE);
  open_object_ =
      hdf5::own(H5Gcreate2(open(parent), hdf5::leaf_name(path), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                H5Gclose, what);
  open_path_ = path;
  objects_.insert(from_root(path));
}

void Hdf5Writer::prepare_dataset(const std::string& path) {
  if (has(path)) {
    throw std::invalid_argument(fmt::format("Hdf5Writer: dataset '{}' is there already", path));
  }
  make_groups(hdf5::parent_path(path));
  objects_.insert(from_root(path));
}

std::int64_t Hdf5Writer::prepare_attribute(const std::string& object) {
  if (object != "/" && !has(object)) {
    throw std::invalid_argument(fmt::format("Hdf5Writer::attribute: there is no '{}'", object));
  }
  return open(object);
}

void Hdf5Writer::write(const std::string& dataset, const Eigen::MatrixXd& matrix, std::string_view unit) {
  const RowMatrix rows = matrix;
  const std::span<const double> values(rows.data(), static_cast<std::size_t>(rows.size()));
  write_array(
      dataset,
      Array::of(values, {static_cast<hsize_t>(rows.rows()), static_cast<hsize_t>(rows.cols())}, unit));
}

void Hdf5Writer::write(const std::string& dataset, std::span<const double> values, std::string_view unit) {
  write_array(dataset, Array::of(values, {values.size()}, unit));
}

void Hdf5Writer::write(const std::string& dataset, std::span<const double> values,
                       const std::vector<std::size_t>& shape, std::string_view unit) {
  write_array(dataset, Array::of(values, {shape.begin(), shape.end()}, unit));
}

void Hdf5Writer::write(const std::string& dataset, std::span<const std::int64_t> values) {
  write_array(dataset, Array::of(values, {values.size()}));
}

void Hdf5Writer::write(const std::string& dataset, std::span<const std::int64_t> values,
                       const std::vector<std::size_t>& shape) {
  write_array(dataset, Array::of(values, {shape.begin(), shape.end()}));
}

void Hdf5Writer::write(const std::string& dataset, std::span<const std::string> values) {
  std::size_t size = 1;
  for (const std::string& value : values) {
    reject_nul(value, dataset);
    size = std::max(size, value.size());
  }
  std::string padded;
  padded.reserve(values.size() * size);
  for (const std::string& value : values) padded.append(value).append(size - value.size(), '\0');
  attempt([&] {
    const Hdf5Handle type = hdf5::make_string_type(size);
    write_array(dataset, {.file_type = type.get(),
                          .memory_type = type.get(),
                          .element_size = size,
                          .data = padded.data(),
                          .count = values.size(),
                          .shape = {values.size()}});
  });
}

void Hdf5Writer::write(const std::string& dataset, std::span<const std::uint8_t> bytes) {
  write_array(dataset, {.file_type = H5T_STD_U8LE,
                        .memory_type = H5T_NATIVE_UINT8,
                        .element_size = 1,
                        .data = bytes.data(),
                        .count = bytes.size(),
                        .shape = {bytes.size()}});
}

void Hdf5Writer::write_array(const std::string& dataset, const Array& array) {
  const hsize_t count =
      std::accumulate(array.shape.begin(), array.shape.end(), hsize_t{1}, std::multiplies<>());
  if (count != array.count) {
    throw std::invalid_argument(fmt::format("Hdf5Writer::write: '{}' has {} values, its shape asks for {}",
                                            dataset, array.count, count));
  }
  attempt([&] {
    prepare_dataset(dataset);
    const std::vector<hsize_t> chunk = hdf5::chunk_shape(array.shape, array.element_size);
    Hdf5Handle handle = hdf5::make_dataset(open(hdf5::parent_path(dataset)), dataset, array.file_type,
                                           array.shape, chunk, hdf5::Storage::kFixed);
    if (array.unit) hdf5::write_string_attribute(handle.get(), "unit", *array.unit);
    const std::string what = fmt::format("dataset '{}' cannot be written", dataset);
    if (count > 0) {
      hdf5::check(H5Dwrite(handle.get(), array.memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.data), what);
    }
    // Data goes to the disk here at the latest. A dataset that failed to close is left to abandon().
    const hid_t id = handle.release();
    hdf5::check(H5Dclose(id), what);
  });
}

void Hdf5Writer::make_group(const std::string& group) {
  attempt([&] { make_groups(group); });
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::string_view value) {
  reject_nul(value, name);
  attempt([&] {
    const hid_t id = prepare_attribute(object);
    hdf5::remove_attribute(id, name);
    hdf5::write_string_attribute(id, name, value);
  });
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, double value) {
  attempt([&] {
    hdf5::write_scalar_attribute(prepare_attribute(object), name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
  });
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::int64_t value) {
  attempt([&] {
    hdf5::write_scalar_attribute(prepare_attribute(object), name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
  });
}

Hdf5GrowingDataset& Hdf5Writer::make_growing(const std::string& dataset, std::size_t columns,
                                             std::string_view unit, Hdf5Precision precision,
                                             const ExpectedRows& rows) {
  attempt([&] {
    prepare_dataset(dataset);
    ChunkCompressor* compressor = nullptr;
    if (precision != Hdf5Precision::kDouble) {
      if (!compressor_) compressor_ = std::make_unique<ChunkCompressor>();
      compressor = compressor_.get();
    }
    growing_.try_emplace(dataset, open(hdf5::parent_path(dataset)), dataset, columns, unit, compressor,
                         precision == Hdf5Precision::kCompressedRounded, rows);
  });
  return growing_.at(dataset);
}

Hdf5GrowingDataset& Hdf5Writer::make_growing_texts(const std::string& dataset, std::size_t text_size) {
  attempt([&] {
    prepare_dataset(dataset);
    growing_.try_emplace(dataset, open(hdf5::parent_path(dataset)), dataset, text_size);
  });
  return growing_.at(dataset);
}

void Hdf5Writer::append_text(Hdf5GrowingDataset& dataset, std::string_view text) {
  attempt([&] { dataset.append_text(text); });
}

void Hdf5Writer::append(Hdf5GrowingDataset& dataset, std::span<const double> values) {
  attempt([&] { dataset.append(values); });
}

void Hdf5Writer::write_full(Hdf5GrowingDataset& dataset) {
  attempt([&] { dataset.write_full(); });
}

// What fails until the disk has the space leaves the file as the last flush has left it.
void Hdf5Writer::flush() {
  attempt([this] {
    for (auto& [name, dataset] : growing_) dataset.write_pending();
    hdf5::reserve_space(file_.get(), temporary_.path());
    is_as_flushed_ = false;
    for (auto& [name, dataset] : growing_) dataset.write_replacements();
    for (const std::string& object : removed_)
      hdf5::check(H5Ldelete(file_.get(), object.c_str(), H5P_DEFAULT), "an object cannot be removed");
    removed_.clear();
    hdf5::check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "cannot be written");
    std::error_code error;
    flushed_size_ = fs::file_size(temporary_.path(), error);
    is_as_flushed_ = !error;
    hdf5::hold_structure_between_flushes(file_.get());
  });
}

void Hdf5Writer::overwrite(const std::string& dataset, std::span<const double> values) {
  attempt([&] {
    const std::string what = fmt::format("dataset '{}' cannot be written", dataset);
    const Hdf5Handle handle = hdf5::own(H5Dopen2(file_.get(), dataset.c_str(), H5P_DEFAULT), H5Dclose, what);
    const Hdf5Handle space = hdf5::own(H5Dget_space(handle.get()), H5Sclose, what);
    const auto count = static_cast<std::size_t>(hdf5::check(H5Sget_simple_extent_npoints(space.get()), what));
    if (count != values.size()) {
      throw std::invalid_argument(
          fmt::format("Hdf5Writer::overwrite: '{}' has {} values, got {}", dataset, count, values.size()));
    }
    hdf5::check(H5Dwrite(handle.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
                what);
  });
}

void Hdf5Writer::overwrite(const std::string& dataset, std::span<const std::uint8_t> bytes) {
  if (has(dataset)) remove(dataset);
  write(dataset, bytes);
}

// Its place in the file becomes free with the next flush: until then the file on the disk refers to it.
void Hdf5Writer::remove(const std::string& object) {
  open_object_.reset();
  const std::string name = fmt::format(".removed {}", removed_.size());
  attempt([&] {
    hdf5::check(H5Lmove(file_.get(), object.c_str(), H5L_SAME_LOC, name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                fmt::format("'{}' cannot be removed", object));
  });
  removed_.push_back(name);
  const std::string path = from_root(object);
  std::erase_if(objects_, [&](const std::string& one) { return one == path || one.starts_with(path + "/"); });
}

std::string Hdf5Writer::copy_to_partial() {
  if (partial_.empty() || !is_as_flushed_)
    throw std::invalid_argument("Hdf5Writer::copy_to_partial: no partial name, or nothing was flushed");
  try {
    TemporaryFile copy(partial_);
    hdf5::copy_flushed(temporary_.path(), copy.path());
    copy.rename_to_target();
    return {};
  } catch (const hdf5::Failure& failure) {
    return InputError({.path = partial_.string()}, failure.what()).what();
  } catch (const InputError& error) {
    return error.what();
  }
}

void Hdf5Writer::close() {
  attempt([this] {
    for (auto& [name, dataset] : growing_) dataset.write_last();
  });
  flush();
  is_as_flushed_ = false;
  growing_.clear();
  open_object_.reset();
  attempt([this] {
    const hid_t id = file_.release();  // after a failed close it must not be touched again
    hdf5::check(H5Fclose(id), "cannot be written");
  });
  std::error_code ignored;
  const auto size = fs::file_size(temporary_.path(), ignored);
  if (!ignored) fs::resize_file(temporary_.path(), size, ignored);  // gives back what was reserved
}

// A closed file is not given up, where it may have taken hours.
void Hdf5Writer::rename_to(const fs::path& name) {
  const std::string reason = temporary_.try_rename_to(name);
  finished_ = true;
  if (reason.empty()) return;
  if (partial_.empty()) throw cannot_be_written(temporary_.target(), reason);
  temporary_.leave();
  throw cannot_be_written(temporary_.target(),
                          fmt::format("{}; the file as far as it was written is left as '{}'", reason,
                                      temporary_.path().string()));
}

void Hdf5Writer::commit() {
  close();
  rename_to(temporary_.target());
  std::error_code ignored;
  if (!partial_.empty()) fs::remove(partial_, ignored);
}

void Hdf5Writer::keep_partial() {
  if (partial_.empty()) throw std::invalid_argument("Hdf5Writer::keep_partial: the partial file has no name");
  close();
  rename_to(partial_);
}

// Leaves what has been flushed under the partial name, or else removes the file, then closes its identifiers.
// After a failed write HDF5 still holds data, and these closes fail again. Their errors are dropped; the
// descriptor of the file is closed nevertheless.
void Hdf5Writer::abandon() noexcept {
  if (is_as_flushed_ && !partial_.empty()) {
    try {
      hdf5::keep_as_flushed(file_.get(), flushed_size_);
      temporary_.try_rename_to(partial_);
    } catch (const std::exception&) {  // the last copy stays
    }
  }
  growing_.clear();
  open_object_.reset();
  file_.reset();
}

}  // namespace sprung::support

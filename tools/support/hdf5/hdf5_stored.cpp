#include "tools/support/hdf5/hdf5_stored.h"

#include <algorithm>
#include <cmath>

#include "tools/support/hdf5/hdf5_library.h"

namespace sprung::support::hdf5 {

namespace {

// "3×2"; "a single value" for rank 0. A negative number stands for any size.
template <typename Size>
std::string format_shape(std::span<const Size> shape) {
  if (shape.empty()) return "a single value";
  std::string text;
  for (const Size size : shape) {
    if (!text.empty()) text += "×";
    text += std::cmp_less(size, 0) ? std::string("any") : std::to_string(size);
  }
  return text;
}

// "[2, 0]": the place of a value in a row-major array.
std::string format_index(std::size_t position, std::span<const std::size_t> shape) {
  std::string text;
  for (std::size_t i = shape.size(); i-- > 0;) {
    text = fmt::format("{}{}{}", position % shape[i], text.empty() ? "" : ", ", text);
    position /= shape[i];
  }
  return fmt::format("[{}]", text);
}

std::string_view type_name(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return "real numbers";
    case H5T_INTEGER:
      return "integers";
    case H5T_STRING:
      return "strings";
    default:
      return "another type";
  }
}

void expect_real(hid_t type, const std::string& label) {
  if (H5Tget_class(type) != H5T_FLOAT) {
    throw Failure(fmt::format("{} must hold real numbers, holds {}", label, type_name(type)));
  }
}

void expect_integer(hid_t type, const std::string& label) {
  if (H5Tget_class(type) != H5T_INTEGER) {
    throw Failure(fmt::format("{} must hold integers, holds {}", label, type_name(type)));
  }
  const bool too_wide = H5Tget_sign(type) == H5T_SGN_NONE && H5Tget_size(type) >= sizeof(std::int64_t);
  if (too_wide || H5Tget_size(type) > sizeof(std::int64_t)) {
    throw Failure(fmt::format("{} holds integers that do not fit into 64 bits with a sign", label));
  }
}

// @return bytes of each string
std::size_t expect_string(hid_t type, const std::string& label) {
  if (H5Tget_class(type) != H5T_STRING) {
    throw Failure(fmt::format("{} must hold strings, holds {}", label, type_name(type)));
  }
  if (check(H5Tis_variable_str(type), label) > 0) {
    throw Failure(fmt::format("{} must hold strings of fixed length, theirs varies", label));
  }
  return H5Tget_size(type);
}

constexpr std::uint64_t kMostCompressed = 1100;  // bytes that deflate makes of one at most

// Refuses filters other than the checksum, and those of compressed histories unless they are allowed:
// compressed data may have any size when they are unpacked. @return whether the data is compressed
bool check_filters(hid_t properties, bool may_be_compressed, const std::string& label) {
  bool is_compressed = false;
  const int num_filters = check(H5Pget_nfilters(properties), label);
  for (int i = 0; i < num_filters; ++i) {
    unsigned flags = 0;
    std::size_t num_values = 0;
    const H5Z_filter_t filter = check(H5Pget_filter2(properties, static_cast<unsigned>(i), &flags,
                                                     &num_values, nullptr, 0, nullptr, nullptr),
                                      label);
    if (filter == H5Z_FILTER_FLETCHER32) continue;
    if (!may_be_compressed || (filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_DEFLATE)) {
      throw Failure(label + " is compressed or coded by a filter, which is not read");
    }
    is_compressed = true;
  }
  return is_compressed;
}

// The content of a padded string.
std::string unpadded(std::string_view text) {
  return std::string(text.substr(0, text.find('\0')));
}

// Name of the file that holds an object: a link may lead to another file.
std::string file_name(hid_t object) {
  const std::string_view what = "the file's name cannot be read";
  std::string name(static_cast<std::size_t>(check(H5Fget_name(object, nullptr, 0), what)) + 1, '\0');
  check(H5Fget_name(object, name.data(), name.size()), what);
  return name;
}

Hdf5Handle open_dataset(std::int64_t file, const std::string& path) {
  // Only what cannot be opened is looked up: a look-up opens each group of the path.
  hid_t opened = H5Oopen(file, path.c_str(), H5P_DEFAULT);
  if (opened < 0) {
    if (!exists(file, path)) throw Failure(fmt::format("dataset '{}' is missing", path));
    opened = H5Oopen(file, path.c_str(), H5P_DEFAULT);  // again, for its reason
  }
  Hdf5Handle object = own(opened, H5Oclose, fmt::format("dataset '{}' cannot be read", path));
  if (H5Iget_type(object.get()) != H5I_DATASET) throw Failure(fmt::format("'{}' is not a dataset", path));
  if (file_name(object.get()) != file_name(file)) {
    throw Failure(fmt::format("dataset '{}' is in another file, which is not read", path));
  }
  return object;
}

}  // namespace

StoredDataset::StoredDataset(std::int64_t file, const std::string& path, std::uint64_t file_size,
                             bool may_be_compressed)
    : label_(fmt::format("dataset '{}'", path)), dataset_(open_dataset(file, path)) {
  const std::string what = label_ + " cannot be read";
  type_ = own(H5Dget_type(dataset_.get()), H5Tclose, what);
  space_ = own(H5Dget_space(dataset_.get()), H5Sclose, what);
  if (H5Sget_simple_extent_type(space_.get()) == H5S_NULL) throw Failure(label_ + " has no values");
  std::vector<hsize_t> dimensions(check(H5Sget_simple_extent_ndims(space_.get()), what));
  check(H5Sget_simple_extent_dims(space_.get(), dimensions.data(), nullptr), what);
  shape_.assign(dimensions.begin(), dimensions.end());
  check_storage(file_size, may_be_compressed);
  for (const std::size_t size : shape_) count_ *= size;
}

// A damaged or hostile header may declare any size. So the data must be in the file before memory is
// allocated.
void StoredDataset::check_storage(std::uint64_t file_size, bool may_be_compressed) const {
  const std::string what = label_ + " cannot be read";
  const Hdf5Handle properties = own(H5Dget_create_plist(dataset_.get()), H5Pclose, what);
  const H5D_layout_t layout = H5Pget_layout(properties.get());
  const bool elsewhere = (layout != H5D_CHUNKED && layout != H5D_CONTIGUOUS && layout != H5D_COMPACT) ||
                         H5Pget_external_count(properties.get()) != 0;
  if (elsewhere) throw Failure(label_ + " has its data in another file, which is not read");
  const bool is_compressed = check_filters(properties.get(), may_be_compressed, label_);
  const std::uint64_t stored = H5Dget_storage_size(dataset_.get());
  const std::uint64_t held = std::min(stored, file_size),
                      limit = is_compressed ? kMostCompressed * held : held;
  const bool empty = std::find(shape_.begin(), shape_.end(), std::size_t{0}) != shape_.end();
  std::uint64_t declared = empty ? 0 : std::max<std::uint64_t>(H5Tget_size(type_.get()), 1);
  for (const std::size_t size : shape_) {
    if (declared != 0 && size > limit / declared) {
      throw Failure(
          fmt::format("{} declares {} values, but holds only {} bytes (it is damaged, or compressed)", label_,
                      format_shape(std::span<const std::size_t>(shape_)), held));
    }
    declared *= size;
  }
}

void StoredDataset::expect_shape(std::span<const std::int64_t> expected) const {
  const bool fits = std::equal(
      expected.begin(), expected.end(), shape_.begin(), shape_.end(),
      [](std::int64_t wanted, std::size_t found) { return wanted < 0 || std::cmp_equal(wanted, found); });
  if (fits) return;
  throw Failure(fmt::format("{} must have shape {}, has {}", label_, format_shape(expected),
                            format_shape(std::span<const std::size_t>(shape_))));
}

void StoredDataset::select_rows(std::size_t first, std::size_t count) {
  if (shape_.empty() || count > shape_[0] || first > shape_[0] - count) {
    throw Failure(fmt::format("{} must have at least {} rows, has {}", label_, first + count,
                              shape_.empty() ? 0 : shape_[0]));
  }
  shape_[0] = count;
  count_ = 1;
  for (const std::size_t size : shape_) count_ *= size;
  std::vector<hsize_t> start(shape_.size(), 0);
  const std::vector<hsize_t> size(shape_.begin(), shape_.end());
  start[0] = first;
  check(H5Sselect_hyperslab(space_.get(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr),
        label_ + " cannot be read");
}

void StoredDataset::read(std::int64_t memory_type, void* values) const {
  const std::string what = label_ + " cannot be read";
  const std::vector<hsize_t> size(shape_.begin(), shape_.end());
  const Hdf5Handle memory =
      own(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, what);
  check(H5Dread(dataset_.get(), memory_type, memory.get(), space_.get(), H5P_DEFAULT, values), what);
}

std::vector<double> StoredDataset::read_doubles() const {
  std::vector<double> values(count_);
  read_doubles(values);
  return values;
}

void StoredDataset::read_doubles(std::span<double> values) const {
  expect_real(type_.get(), label_);
  if (count_ > 0) read(H5T_NATIVE_DOUBLE, values.data());
  const auto bad =
      std::find_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
  if (bad != values.end()) {
    throw Failure(fmt::format("{} has {} at {}", label_, *bad,
                              format_index(static_cast<std::size_t>(bad - values.begin()), shape_)));
  }
}

std::vector<std::int64_t> StoredDataset::read_integers() const {
  expect_integer(type_.get(), label_);
  std::vector<std::int64_t> values(count_);
  if (count_ > 0) read(H5T_NATIVE_INT64, values.data());
  return values;
}

std::vector<std::string> StoredDataset::read_strings() const {
  const std::size_t size = expect_string(type_.get(), label_);
  std::string characters(size * count_, '\0');
  if (count_ > 0) read(type_.get(), characters.data());
  std::vector<std::string> values;
  for (std::size_t i = 0; i < count_; ++i) {
    values.push_back(unpadded(std::string_view(characters).substr(i * size, size)));
  }
  return values;
}

StoredAttribute::StoredAttribute(std::int64_t file, const std::string& object, const std::string& name,
                                 std::uint64_t file_size)
    : label_(fmt::format("attribute '{}' of '{}'", name, object)) {
  const std::string what = label_ + " cannot be read";
  const htri_t is_there = H5Aexists_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT);
  if (is_there < 0 && !exists(file, object)) throw Failure(fmt::format("'{}' is missing", object));
  if (check(is_there, what) == 0) throw Failure(label_ + " is missing");
  attribute_ =
      own(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, what);
  type_ = own(H5Aget_type(attribute_.get()), H5Tclose, what);
  const Hdf5Handle space = own(H5Aget_space(attribute_.get()), H5Sclose, what);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) throw Failure(label_ + " must be a single value");
  if (H5Tget_size(type_.get()) > file_size) throw Failure(label_ + " declares more bytes than the file has");
}

std::int64_t StoredAttribute::read_integer() const {
  expect_integer(type_.get(), label_);
  std::int64_t value = 0;
  check(H5Aread(attribute_.get(), H5T_NATIVE_INT64, &value), label_ + " cannot be read");
  return value;
}

double StoredAttribute::read_real() const {
  expect_real(type_.get(), label_);
  double value = 0.0;
  check(H5Aread(attribute_.get(), H5T_NATIVE_DOUBLE, &value), label_ + " cannot be read");
  if (!std::isfinite(value)) throw Failure(label_ + " must be finite");
  return value;
}

std::string StoredAttribute::read_string() const {
  std::string characters(expect_string(type_.get(), label_), '\0');
  check(H5Aread(attribute_.get(), type_.get(), characters.data()), label_ + " cannot be read");
  return unpadded(characters);
}

}  // namespace sprung::support::hdf5

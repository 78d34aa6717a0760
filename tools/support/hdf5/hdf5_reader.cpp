#include "tools/support/hdf5/hdf5_reader.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_library.h"
#include "tools/support/hdf5/hdf5_stored.h"

namespace sprung::support {

namespace fs = std::filesystem;

template <typename Function>
auto Hdf5Reader::attempt(Function&& function) const {
  try {
    return function();
  } catch (const hdf5::Failure& failure) {
    throw InputError({.path = path_.string()}, failure.what());
  }
}

Hdf5Reader::Hdf5Reader(fs::path path, Compression compression)
    : path_(std::move(path)), compression_(compression) {
  hdf5::initialize();
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (status.type() == fs::file_type::not_found) fail("there is no such file");
  if (fs::is_directory(status)) fail("is a folder, not a file");
  errno = 0;
  if (!std::ifstream(path_)) fail(fmt::format("cannot be read: {}", std::strerror(errno)));
  file_size_ = fs::file_size(path_, error);
  if (error) fail(fmt::format("cannot be read: {}", error.message()));
  if (file_size_ == 0) fail("is empty");
  if (H5Fis_hdf5(path_.c_str()) <= 0) fail("is not an HDF5 file");
  attempt([this] {
    const std::string_view what = "cannot be read";
    const Hdf5Handle access = hdf5::own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
    hdf5::check(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG), what);
    hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, access.get());
    // In a Python process h5py may have the file open. All that have it open must close it in the same way.
    if (file < 0) file = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    file_ = hdf5::own(file, H5Fclose, what);
  });
}

void Hdf5Reader::fail(std::string_view message) const {
  throw InputError({.path = path_.string()}, message);
}

hdf5::StoredDataset Hdf5Reader::open(const std::string& dataset) const {
  return {file_.get(), dataset, file_size_, compression_ == Compression::kAllowed};
}

bool Hdf5Reader::has(const std::string& object) const {
  return attempt([&] { return hdf5::exists(file_.get(), object); });
}

std::vector<std::int64_t> Hdf5Reader::shape(const std::string& dataset) const {
  return attempt([&] {
    const hdf5::StoredDataset stored = open(dataset);
    return std::vector<std::int64_t>(stored.shape().begin(), stored.shape().end());
  });
}

std::vector<double> Hdf5Reader::reals(const std::string& dataset,
                                      const std::vector<std::int64_t>& shape) const {
  return attempt([&] {
    const hdf5::StoredDataset stored = open(dataset);
    stored.expect_shape(shape);
    return stored.read_doubles();
  });
}

std::vector<std::int64_t> Hdf5Reader::read_reals(
    const std::string& dataset, const std::vector<std::int64_t>& shape,
    const std::function<std::span<double>(const std::vector<std::int64_t>&)>& place) const {
  return attempt([&] {
    const hdf5::StoredDataset stored = open(dataset);
    stored.expect_shape(shape);
    std::vector<std::int64_t> found(stored.shape().begin(), stored.shape().end());
    stored.read_doubles(place(found));
    return found;
  });
}

std::vector<double> Hdf5Reader::real_rows(const std::string& dataset, std::size_t first,
                                          std::size_t count) const {
  return attempt([&] {
    hdf5::StoredDataset stored = open(dataset);
    stored.select_rows(first, count);
    return stored.read_doubles();
  });
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& dataset,
                                               const std::vector<std::int64_t>& shape) const {
  return attempt([&] {
    const hdf5::StoredDataset stored = open(dataset);
    stored.expect_shape(shape);
    return stored.read_integers();
  });
}

std::vector<std::string> Hdf5Reader::strings(const std::string& dataset,
                                             const std::vector<std::int64_t>& shape) const {
  return attempt([&] {
    const hdf5::StoredDataset stored = open(dataset);
    stored.expect_shape(shape);
    return stored.read_strings();
  });
}

bool Hdf5Reader::has_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] {
    const htri_t is_there = H5Aexists_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT);
    if (is_there < 0 && !hdf5::exists(file_.get(), object)) return false;
    return hdf5::check(is_there, fmt::format("attribute '{}' of '{}' cannot be looked up", name, object)) > 0;
  });
}

std::string Hdf5Reader::string_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] { return hdf5::StoredAttribute(file_.get(), object, name, file_size_).read_string(); });
}

double Hdf5Reader::real_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] { return hdf5::StoredAttribute(file_.get(), object, name, file_size_).read_real(); });
}

std::int64_t Hdf5Reader::integer_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] { return hdf5::StoredAttribute(file_.get(), object, name, file_size_).read_integer(); });
}

}  // namespace sprung::support

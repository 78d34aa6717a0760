#include "tools/support/hdf5/hdf5_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <type_traits>

#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/hdf5_library.h"
#include "tools/support/hdf5/hdf5_stored.h"

namespace sprung::support {

namespace fs = std::filesystem;

namespace {

// Called by C: nothing may be thrown through it.
herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* names) noexcept {
  try {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return 0;
  } catch (...) {
    return -1;
  }
}

}  // namespace

template <typename Function>
auto Hdf5Reader::attempt(Function&& function) const {
  try {
    return function();
  } catch (const hdf5::Failure& failure) {
    throw InputError({.path = path_.string()}, failure.what());
  }
}

Hdf5Reader::Hdf5Reader(fs::path path) : path_(std::move(path)) {
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
    file_ = hdf5::own(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose, what);
  });
}

void Hdf5Reader::fail(std::string_view message) const {
  throw InputError({.path = path_.string()}, message);
}

bool Hdf5Reader::has(const std::string& object) const {
  return attempt([&] { return hdf5::exists(file_.get(), object); });
}

std::vector<std::string> Hdf5Reader::members(const std::string& group) const {
  return attempt([&] {
    const Hdf5Handle handle = hdf5::open_object(file_.get(), group, "group");
    std::vector<std::string> names;
    hdf5::check(H5Literate(handle.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_name, &names),
                fmt::format("group '{}' cannot be read", group));
    std::sort(names.begin(), names.end());
    return names;
  });
}

std::vector<std::size_t> Hdf5Reader::shape(const std::string& dataset) const {
  return attempt([&] { return hdf5::StoredDataset(file_.get(), dataset, file_size_).shape(); });
}

template <typename Scalar>
std::vector<Scalar> Hdf5Reader::read(const std::string& dataset, std::span<const std::int64_t> shape) const {
  return attempt([&] {
    const hdf5::StoredDataset stored(file_.get(), dataset, file_size_);
    stored.expect_shape(shape);
    if constexpr (std::is_same_v<Scalar, double>) {
      return stored.read_doubles();
    } else {
      return stored.read_integers();
    }
  });
}

Eigen::MatrixXd Hdf5Reader::matrix(const std::string& dataset, std::int64_t rows,
                                   std::int64_t columns) const {
  return attempt([&]() -> Eigen::MatrixXd {
    const hdf5::StoredDataset stored(file_.get(), dataset, file_size_);
    stored.expect_shape(std::array{rows, columns});
    const std::vector<double> values = stored.read_doubles();
    return Eigen::Map<const RowMatrix>(values.data(), static_cast<Eigen::Index>(stored.shape()[0]),
                                       static_cast<Eigen::Index>(stored.shape()[1]));
  });
}

Eigen::VectorXd Hdf5Reader::vector(const std::string& dataset, std::int64_t size) const {
  const std::vector<double> values = read<double>(dataset, std::array{size});
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<double> Hdf5Reader::array(const std::string& dataset, std::span<const std::size_t> shape) const {
  const std::vector<std::int64_t> expected(shape.begin(), shape.end());
  return read<double>(dataset, expected);
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& dataset, std::int64_t size) const {
  return read<std::int64_t>(dataset, std::array{size});
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& dataset, std::int64_t rows,
                                               std::int64_t columns) const {
  return read<std::int64_t>(dataset, std::array{rows, columns});
}

std::vector<std::string> Hdf5Reader::strings(const std::string& dataset) const {
  return attempt([&] {
    const hdf5::StoredDataset stored(file_.get(), dataset, file_size_);
    stored.expect_shape(std::array{std::int64_t{-1}});
    return stored.read_strings();
  });
}

bool Hdf5Reader::has_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] {
    if (!hdf5::exists(file_.get(), object)) return false;
    return hdf5::check(H5Aexists_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT),
                       fmt::format("attribute '{}' of '{}' cannot be looked up", name, object)) > 0;
  });
}

std::string Hdf5Reader::string_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] { return hdf5::StoredAttribute(file_.get(), object, name, file_size_).read_string(); });
}

double Hdf5Reader::number_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] { return hdf5::StoredAttribute(file_.get(), object, name, file_size_).read_double(); });
}

std::int64_t Hdf5Reader::integer_attribute(const std::string& object, const std::string& name) const {
  return attempt([&] { return hdf5::StoredAttribute(file_.get(), object, name, file_size_).read_integer(); });
}

}  // namespace sprung::support

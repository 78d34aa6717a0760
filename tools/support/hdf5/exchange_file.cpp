#include "tools/support/hdf5/exchange_file.h"

#include "tools/support/errors/input_error.h"
#include "tools/support/hdf5/created_file.h"
#include "tools/support/hdf5/hdf5_library.h"
#include "tools/support/hdf5/row_matrix.h"

namespace sprung::support {

namespace {

Hdf5Handle make_variable_string_type() {
  const std::string_view what = "an HDF5 string type cannot be made";
  Hdf5Handle type = hdf5::own(H5Tcopy(H5T_C_S1), H5Tclose, what);
  hdf5::check(H5Tset_size(type.get(), H5T_VARIABLE), what);
  hdf5::check(H5Tset_cset(type.get(), H5T_CSET_UTF8), what);
  return type;
}

}  // namespace

ExchangeFile::ExchangeFile(std::filesystem::path target) : temporary_(std::move(target)) {
  hdf5::initialize();
  // MBSim's reader takes objects in the order in which they were made.
  attempt([this] { file_ = hdf5::create_file(temporary_.path(), true); });
}

ExchangeFile::~ExchangeFile() {
  file_.reset();
}

template <typename Function>
void ExchangeFile::attempt(Function&& function) {
  try {
    function();
  } catch (const hdf5::Failure& failure) {
    throw InputError({.path = temporary_.target().string()}, failure.what());
  }
}

void ExchangeFile::write_scalar(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                                const void* value) {
  attempt([&] {
    const std::string what = "dataset '" + name + "' cannot be written";
    const Hdf5Handle space = hdf5::own(H5Screate(H5S_SCALAR), H5Sclose, what);
    const Hdf5Handle properties = hdf5::make_properties(H5P_DATASET_CREATE);
    const Hdf5Handle dataset = hdf5::own(H5Dcreate2(file_.get(), name.c_str(), file_type, space.get(),
                                                    H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                                         H5Dclose, what);
    hdf5::check(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value), what);
  });
}

void ExchangeFile::write_array(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                               const void* values, const std::vector<std::uint64_t>& shape) {
  attempt([&] {
    const std::vector<hsize_t> extents(shape.begin(), shape.end());
    const std::string parent = hdf5::parent_path(name);
    const Hdf5Handle group =
        hdf5::own(H5Oopen(file_.get(), parent.empty() ? "/" : parent.c_str(), H5P_DEFAULT), H5Oclose,
                  "dataset '" + name + "' cannot be made");
    const Hdf5Handle dataset =
        hdf5::make_dataset(group.get(), name, file_type, extents,
                           hdf5::chunk_shape(extents, H5Tget_size(file_type)), hdf5::Storage::kFixed);
    hdf5::check(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values),
                "dataset '" + name + "' cannot be written");
  });
}

void ExchangeFile::write_number(const std::string& name, double value) {
  write_scalar(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void ExchangeFile::write_integer(const std::string& name, std::int64_t value) {
  write_scalar(name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void ExchangeFile::write_text(const std::string& name, const std::string& text) {
  const char* const begin = text.c_str();
  Hdf5Handle type;
  attempt([&] { type = make_variable_string_type(); });
  write_scalar(name, type.get(), type.get(), &begin);
}

void ExchangeFile::write_vector(const std::string& name, const Eigen::VectorXd& values) {
  write_array(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(),
              {static_cast<std::uint64_t>(values.size())});
}

void ExchangeFile::write_matrix(const std::string& name, const Eigen::MatrixXd& matrix) {
  const RowMatrix rows = matrix;
  write_array(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rows.data(),
              {static_cast<std::uint64_t>(rows.rows()), static_cast<std::uint64_t>(rows.cols())});
}

void ExchangeFile::write_integers(const std::string& name, const std::vector<std::int32_t>& values) {
  write_array(name, H5T_STD_I32LE, H5T_NATIVE_INT32, values.data(), {values.size()});
}

void ExchangeFile::write_long_integers(const std::string& name, const std::vector<std::int64_t>& values) {
  write_array(name, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data(), {values.size()});
}

void ExchangeFile::make_group(const std::string& name) {
  attempt([&] {
    const Hdf5Handle properties = hdf5::make_properties(H5P_GROUP_CREATE);
    hdf5::own(H5Gcreate2(file_.get(), name.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Gclose,
              "group '" + name + "' cannot be made");
  });
}

void ExchangeFile::attribute(const std::string& object, const std::string& name, const std::string& text) {
  attempt([&] {
    const std::string what = "attribute '" + name + "' of '" + object + "' cannot be written";
    const char* const begin = text.c_str();
    const Hdf5Handle type = make_variable_string_type();
    const Hdf5Handle space = hdf5::own(H5Screate(H5S_SCALAR), H5Sclose, what);
    const Hdf5Handle handle = hdf5::own(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose, what);
    const Hdf5Handle attribute =
        hdf5::own(H5Acreate2(handle.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose, what);
    hdf5::check(H5Awrite(attribute.get(), type.get(), &begin), what);
  });
}

void ExchangeFile::commit() {
  attempt([this] {
    hdf5::check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "cannot be written");
    const hid_t id = file_.release();
    hdf5::check(H5Fclose(id), "cannot be written");
  });
  temporary_.rename_to_target();
}

}  // namespace sprung::support

#include "tests/reduce/superelement/hdf5_tampering.h"

#include <hdf5.h>

#include <stdexcept>

namespace sprung::reduce::testing {

namespace {

void require(bool good, const std::string& what) {
  if (!good) throw std::runtime_error("tampering failed: " + what);
}

}  // namespace

Hdf5Tampering::Hdf5Tampering(const std::string& path)
    : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {
  require(file_ >= 0, path);
}

Hdf5Tampering::~Hdf5Tampering() {
  H5Fclose(file_);
}

void Hdf5Tampering::remove(const std::string& dataset) {
  require(H5Ldelete(file_, dataset.c_str(), H5P_DEFAULT) >= 0, dataset);
}

void Hdf5Tampering::add(const std::string& dataset, const std::vector<std::uint64_t>& shape,
                        const std::vector<double>& values) {
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t set =
      H5Dcreate2(file_, dataset.c_str(), H5T_IEEE_F64LE, space, links, H5P_DEFAULT, H5P_DEFAULT);
  require(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, dataset);
  H5Dclose(set);
  H5Pclose(links);
  H5Sclose(space);
}

void Hdf5Tampering::replace(const std::string& dataset, const std::vector<std::uint64_t>& shape,
                            const std::vector<double>& values) {
  remove(dataset);
  add(dataset, shape, values);
}

void Hdf5Tampering::set_unit(const std::string& dataset, const std::string& unit) {
  const hid_t set = H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT);
  if (H5Aexists(set, "unit") > 0) H5Adelete(set, "unit");
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, unit.size());
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(set, "unit", type, space, H5P_DEFAULT, H5P_DEFAULT);
  require(H5Awrite(attribute, type, unit.data()) >= 0, dataset);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
}

void Hdf5Tampering::set(const std::string& dataset, std::size_t index, double value) {
  const hid_t set = H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(set);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  require(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, dataset);
  values.at(index) = value;
  require(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, dataset);
  H5Sclose(space);
  H5Dclose(set);
}

void Hdf5Tampering::set_attribute(const std::string& name, std::int64_t value) {
  const hid_t attribute = H5Aopen(file_, name.c_str(), H5P_DEFAULT);
  require(H5Awrite(attribute, H5T_NATIVE_INT64, &value) >= 0, name);
  H5Aclose(attribute);
}

void Hdf5Tampering::remove_attribute(const std::string& name) {
  require(H5Adelete(file_, name.c_str()) >= 0, name);
}

}  // namespace sprung::reduce::testing

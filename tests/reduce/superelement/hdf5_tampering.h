#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sprung::reduce::testing {

/// Changes a whole HDF5 file as another program would, checksums kept right. Open as long as the object
/// lives.
class Hdf5Tampering {
 public:
  explicit Hdf5Tampering(const std::string& path);
  Hdf5Tampering(const Hdf5Tampering&) = delete;
  ~Hdf5Tampering();

  void remove(const std::string& dataset);
  /// Adds a dataset of real numbers, and the groups on its path.
  void add(const std::string& dataset, const std::vector<std::uint64_t>& shape,
           const std::vector<double>& values);
  void replace(const std::string& dataset, const std::vector<std::uint64_t>& shape,
               const std::vector<double>& values);
  void set_unit(const std::string& dataset, const std::string& unit);
  void set(const std::string& dataset, std::size_t index, double value);  ///< one number, row-major index
  void set_attribute(const std::string& name, std::int64_t value);        ///< of the file
  void remove_attribute(const std::string& name);

 private:
  std::int64_t file_ = -1;
};

}  // namespace sprung::reduce::testing

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/files/temporary_file.h"
#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support {

/// Writes an HDF5 file in the form that another program expects: scalars, texts of variable length and
/// integers of 32 bits, which the files of this project do not have (Hdf5Writer). The file is written under a
/// temporary name beside the target, and `commit` renames it. Equal calls give equal bytes, but for texts.
/// Every function throws InputError with the file and the system's reason when it fails.
/// Checked by tests/tools/support/exchange_file_test.cpp
class ExchangeFile {
 public:
  explicit ExchangeFile(std::filesystem::path target);
  ExchangeFile(ExchangeFile&&) = delete;
  ~ExchangeFile();  ///< removes the file if it was not committed

  // Names are those of objects at the root of the file.
  void write_number(const std::string& name, double value);         ///< scalar
  void write_integer(const std::string& name, std::int64_t value);  ///< scalar of 64 bits
  void write_text(const std::string& name, const std::string& text);
  void write_vector(const std::string& name, const Eigen::VectorXd& values);  ///< rank 1, not empty
  void write_matrix(const std::string& name, const Eigen::MatrixXd& matrix);  ///< rank 2, not empty
  void write_integers(const std::string& name, const std::vector<std::int32_t>& values);
  void write_long_integers(const std::string& name, const std::vector<std::int64_t>& values);
  void make_group(const std::string& name);
  /// A text as attribute of an object.
  void attribute(const std::string& object, const std::string& name, const std::string& text);

  void commit();

 private:
  template <typename Function>
  void attempt(Function&& function);
  void write_scalar(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                    const void* value);
  void write_array(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                   const void* values, const std::vector<std::uint64_t>& shape);

  TemporaryFile temporary_;
  Hdf5Handle file_;
};

}  // namespace sprung::support

#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/files/temporary_file.h"

namespace sprung::reduce {

/// A number with all its digits, as text.
std::string format_real(double number);

/// Files that belong together: they get their names when all are written, so that a full disk leaves those of
/// before. Checked by tests/reduce/export/export_test.py
class TextFiles {
 public:
  /// @throws support::InputError if it cannot be written
  void add(const std::filesystem::path& path, std::string_view text);
  void commit();  ///< @throws support::InputError if a name cannot be given

 private:
  std::vector<std::unique_ptr<support::TemporaryFile>> written_;
};

/// Writes a file whole or not at all.
/// @throws support::InputError if it cannot be written
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// A Matrix Market file. @param comment  one line, without '%'
std::string format_matrix_market(const Eigen::MatrixXd& matrix, std::string_view comment);
/// The lower triangle of a symmetric matrix.
std::string format_symmetric_matrix_market(const Eigen::SparseMatrix<double>& matrix,
                                           std::string_view comment);

}  // namespace sprung::reduce

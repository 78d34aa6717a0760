#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <filesystem>
#include <string>
#include <string_view>

namespace sprung::reduce {

/// A number with all its digits, as text.
std::string format_real(double number);

/// Writes a file whole or not at all.
/// @throws support::InputError if it cannot be written
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// A Matrix Market file. @param comment  one line, without '%'
std::string format_matrix_market(const Eigen::MatrixXd& matrix, std::string_view comment);
/// The lower triangle of a symmetric matrix.
std::string format_symmetric_matrix_market(const Eigen::SparseMatrix<double>& matrix,
                                           std::string_view comment);

}  // namespace sprung::reduce

#include "reduce/export/text_output.h"

#include <fmt/format.h>

#include <fstream>

#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

std::string format_real(double number) {
  return fmt::format("{:.17g}", number == 0.0 ? 0.0 : number);  // no −0
}

void TextFiles::add(const std::filesystem::path& path, std::string_view text) {
  const auto& file = written_.emplace_back(std::make_unique<support::TemporaryFile>(path));
  std::ofstream stream(file->path(), std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) throw support::InputError({.path = path.string()}, "could not be written");
}

void TextFiles::commit() {
  for (const auto& file : written_) file->rename_to_target();
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  TextFiles files;
  files.add(path, text);
  files.commit();
}

std::string format_matrix_market(const Eigen::MatrixXd& matrix, std::string_view comment) {
  std::string text = fmt::format("%%MatrixMarket matrix array real general\n% {}\n{} {}\n", comment,
                                 matrix.rows(), matrix.cols());
  for (Eigen::Index i = 0; i < matrix.size(); ++i) text += format_real(matrix(i)) + "\n";
  return text;
}

std::string format_symmetric_matrix_market(const Eigen::SparseMatrix<double>& matrix,
                                           std::string_view comment) {
  std::string entries;
  Eigen::Index count = 0;
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      if (entry.row() < column || entry.value() == 0.0) continue;
      entries += fmt::format("{} {} {}\n", entry.row() + 1, column + 1, format_real(entry.value()));
      ++count;
    }
  }
  return fmt::format("%%MatrixMarket matrix coordinate real symmetric\n% {}\n{} {} {}\n", comment,
                     matrix.rows(), matrix.cols(), count) +
         entries;
}

}  // namespace sprung::reduce

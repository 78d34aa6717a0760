#include "reduce/matrices/calculix_matrix.h"

#include <fmt/format.h>

namespace sprung::reduce {

MatrixEntries read_calculix_matrix(const std::filesystem::path& path, const FreedomList& freedoms) {
  TextLines lines(path);
  MatrixEntries entries{.path = path.string(), .items = {}, .is_full = false};
  while (lines.next()) {
    const std::vector<TextField> fields = lines.fields();
    if (fields.empty()) continue;
    if (fields.size() != 3) {
      throw lines.error(fmt::format("has {} numbers, expected 3 (row, column, value)", fields.size()));
    }
    const auto row = static_cast<int>(lines.integer(fields[0], 1, freedoms.size())) - 1;
    const auto column = static_cast<int>(lines.integer(fields[1], 1, freedoms.size())) - 1;
    add_entry(lines, row, column, fields[2], entries);
  }
  if (entries.items.empty()) throw lines.error("has no entries");
  return entries;
}

}  // namespace sprung::reduce
